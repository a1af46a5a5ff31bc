"""A paper that was handed in: marks, what was said of each part, what to practise."""

from __future__ import annotations

import pickle
import time
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import msgspec
from msgspec.structs import replace

from quizgen.bank.bank import Bank
from quizgen.core.decoding import decode_json
from quizgen.grading.feedback import name_truth
from quizgen.grading.options import GradingOptions
from quizgen.grading.verdict import Verdict
from quizgen.kinds.rubric import Suggestion, suggest_marks
from quizgen.paper.answer_key import KeyPart, KeyQuestion
from quizgen.paper.grading import PartResult, QuestionGrader, round_to_quarters
from quizgen.practice.input_fields import join_fields
from quizgen.practice.scheduler import ReviewEvent, ReviewRating
from quizgen.store import OutcomeRecord
from quizgen.web.job_cache import WorkerPool
from quizgen.web.question_view import PaperView, PartView, QuestionView
from quizgen.web.read_errors import ReadErrorView, explain_read_error
from quizgen.web.views import translate_page

WRONG = frozenset({"wrong", "partial"})


@dataclass(frozen=True)
class ExamPartResult:
    """One part of a submitted exam."""

    part: PartView
    values: Sequence[str]
    """What stands in its fields."""
    result: PartResult
    own: float | None
    """The share of its points that the learner gave it, where a person has to decide."""
    lang: str
    ticked: Mapping[str, float]
    """Criteria that the learner ticked, each with its share."""
    suggestion: Suggestion | None = None
    """What is suggested of an own sentence."""
    wrong_ideas: Sequence[str] = ()
    """What to tell of the known wrong ideas in it."""

    @property
    def verdict(self) -> Verdict:
        """Return the verdict of grading."""
        return self.result.verdict

    @property
    def answer_text(self) -> str:
        """Return what was typed or ticked, in the words of the page."""
        return name_truth(self.result.kind, self.result.typed, self.lang)

    @property
    def unread(self) -> ReadErrorView | None:
        """Return why the answer could not be read; None if it could."""
        if self.verdict.is_graded or self.verdict.needs_self_marking:
            return None
        return explain_read_error(self.part.field, self.values, self.verdict, self.lang)

    @property
    def marks(self) -> Fraction | None:
        """Return the marks; None while undecided."""
        if self.result.is_blank:
            return Fraction(0)
        if self.result.marks is None and self.own is not None:
            return round_to_quarters(Fraction(str(self.own)) * self.result.points)
        return self.result.marks

    @property
    def reason(self) -> str:
        """Return why it did not get all points, in a sentence."""
        if self.result.is_blank:
            return translate_page(self.lang, "results.blank")
        said = self.unread.message if self.unread else self.verdict.message
        return said or translate_page(self.lang, f"results.{self.word}")

    @property
    def lost(self) -> Fraction:
        """Return the points that it cost; none while undecided."""
        return Fraction(0) if self.marks is None else self.result.points - self.marks

    @property
    def status(self) -> str:
        """Return ``blank``, ``open``, ``judged`` (by the learner) or the verdict."""
        if self.result.status == "open":
            return "open" if self.own is None else "judged"
        return self.result.status

    @property
    def word(self) -> str:
        """Return the key of the word that the status is shown by."""
        return self.result.word if self.status == self.result.status else self.status


@dataclass(frozen=True)
class ExamQuestionResult:
    """One question of a submitted exam."""

    made: QuestionView
    parts: tuple[ExamPartResult, ...]

    @property
    def marks(self) -> Fraction:
        """Return the marks decided so far."""
        return sum((part.marks or Fraction(0) for part in self.parts), Fraction(0))

    @property
    def points(self) -> Fraction:
        """Return the most marks the question can have."""
        return sum((part.result.points for part in self.parts), Fraction(0))


@dataclass(frozen=True)
class ExamLoss:
    """Parts of one question that cost points for the same reason."""

    made: QuestionView
    parts: tuple[ExamPartResult, ...]

    @property
    def points(self) -> Fraction:
        """Return the points that they cost together."""
        return sum((part.lost for part in self.parts), Fraction(0))

    @property
    def name(self) -> str:
        """Return the number of the question with the labels of the parts: ``3b, c``."""
        labels = ", ".join(part.part.label for part in self.parts)
        return f"{self.made.wanted.number}{labels}"


@dataclass(frozen=True)
class ExamResults:
    """The results of a submitted exam."""

    questions: tuple[ExamQuestionResult, ...]

    @property
    def marks(self) -> Fraction:
        """Return the marks decided so far."""
        return sum((question.marks for question in self.questions), Fraction(0))

    @property
    def points(self) -> Fraction:
        """Return the most marks the paper can have."""
        return sum((question.points for question in self.questions), Fraction(0))

    @property
    def to_judge(self) -> int:
        """Return the number of sentences that the learner has yet to grade."""
        return len(self.open_parts())

    @property
    def highest(self) -> Fraction:
        """Return the marks it can still have, once all sentences are judged."""
        return self.marks + sum((part.result.points for part in self.open_parts()), Fraction(0))

    def open_parts(self) -> list[ExamPartResult]:
        """Return the sentences that the learner has yet to grade."""
        return [part for q in self.questions for part in q.parts if part.status == "open"]

    def losses(self) -> list[ExamLoss]:
        """Return what cost points and why, the most first."""
        found: dict[tuple[str, str], list[ExamPartResult]] = {}
        for question in self.questions:
            for part in question.parts:
                if part.lost:
                    key = (question.made.wanted.number, part.reason)
                    found.setdefault(key, []).append(part)
        made = {question.made.wanted.number: question.made for question in self.questions}
        losses = [ExamLoss(made[number], tuple(parts)) for (number, _), parts in found.items()]
        return sorted(losses, key=lambda one: -one.points)


def plan_seconds(paper: PaperView, bank: Bank) -> dict[str, float]:
    """Return for how long each question of a paper is planned, by its number.

    The minutes of the paper are shared out as those of its questions are, or as their points where
    the bank has lost one of them.
    """
    names = [item.wanted.template for item in paper.items]
    if all(name in bank.template_paths for name in names):
        weights = [float(bank.minutes(name)) for name in names]
    else:
        weights = [sum(part.points for part in item.parts) for item in paper.items]
    whole = paper.minutes * 60 / (sum(weights) or 1)
    return {i.wanted.number: w * whole for i, w in zip(paper.items, weights, strict=True)}


@dataclass(frozen=True)
class MarkPaper:
    """Grades a paper in a worker: packed keys of its questions, and what was typed at each part.

    It stays in memory as long as its results do, hence packed: a tenth of its JSON.
    """

    lang: str
    keys: bytes
    typed: tuple[tuple[str, ...], ...]
    decimal: str = "auto"

    def run(self, bank: Bank) -> bytes:
        """Return the results of each question's parts as JSON."""
        del bank
        found = []
        for key, typed in zip(
            decode_json(zlib.decompress(self.keys), list[KeyQuestion]), self.typed, strict=True
        ):
            marker = QuestionGrader(key, GradingOptions(self.lang, self.decimal))
            found.append(
                [
                    _strip_numbers(marker.grade_part(*one))
                    for one in zip(key.parts, typed, strict=True)
                ]
            )
        return pickle.dumps(found)


def _strip_numbers(result: PartResult) -> PartResult:
    """Return a result without the values that only later parts of its question need."""
    return replace(result, verdict=_strip_values(result.verdict))


def _strip_values(verdict: Verdict) -> Verdict:
    """Return a verdict without values, and so its cells."""
    return replace(verdict, values=(), cells=tuple(map(_strip_values, verdict.cells)))


async def grade_exam(
    workers: WorkerPool,
    paper: PaperView,
    answers: Mapping[str, list[str]],
    own: Mapping[str, float],
    learner: int,
    decimal: str = "auto",
) -> ExamResults:
    """Return the results of a paper, graded in a worker process.

    Parameters
    ----------
    workers : WorkerPool
    paper : PaperView
    answers : mapping
        Part to what stands in its fields.
    own : mapping
        Part to the share that the learner gave it.
    learner : int
    decimal : str
        The decimal sign by which the answers are read.
    """
    lang = paper.items[0].wanted.lang
    values = [[answers.get(part.field.id, ()) for part in item.parts] for item in paper.items]
    typed = tuple(
        tuple(
            join_fields(part.field.control, one, part.field.marks)
            for part, one in zip(item.parts, mine, strict=True)
        )
        for item, mine in zip(paper.items, values, strict=True)
    )
    keys = zlib.compress(msgspec.json.encode([item.key for item in paper.items]), 1)
    data = await workers.get_result(MarkPaper(lang, keys, typed, decimal), learner)
    results = pickle.loads(data)  # noqa: S301 - from a process of our own
    return ExamResults(tuple(
        ExamQuestionResult(item, tuple(
            _build_part_result(part, given, result, key, own, lang)
            for part, given, result, key in zip(item.parts, *told, item.key.parts, strict=True)
        ))
        for item, *told in zip(paper.items, values, results, strict=True)
    ))  # fmt: skip


def _build_part_result(
    part: PartView,
    values: Sequence[str],
    result: PartResult,
    key: KeyPart,
    own: Mapping[str, float],
    lang: str,
) -> ExamPartResult:
    """Return a part with its result and, for an own sentence, what is suggested of it."""
    name, spec = part.field.id, key.parse_spec(proven=True)
    ticked = {one: own[f"{name}/{one}"] for one in part.criteria if f"{name}/{one}" in own}
    made = suggest_marks(spec, result.typed)
    wrong = tuple(spec.notes.get(lang, {}).get(n, "") for n in made.mistakes) if made else ()
    return ExamPartResult(part, values, result, own.get(name), lang, ticked, made, wrong)


def review_events(bank: Bank, results: ExamResults) -> list[ReviewEvent]:
    """Return the review of each template by a paper; undecided parts do not count."""
    found = []
    for question in results.questions:
        parts = [part for part in question.parts if part.status != "open"]
        if parts:
            right = all(part.verdict.verdict == "correct" for part in parts)
            notes = tuple(part.verdict.note for part in parts if part.status in WRONG)
            origin = bank.origin(question.made.wanted.template)
            found.append(
                ReviewEvent(origin, ReviewRating.GOOD if right else ReviewRating.AGAIN, notes)
            )
    return found


def outcome_records(results: ExamResults, sitting: str) -> tuple[OutcomeRecord, ...]:
    """Return the outcome of each part, for progress; blank parts count as not right.

    ``sitting`` is the id of the exam.
    """
    now = time.time()
    return tuple(
        OutcomeRecord(
            question.made.wanted.template,
            question.made.topic,
            part.part.label,
            part.verdict.note if part.status in WRONG else "",
            part.verdict.verdict == "correct",
            part.verdict.verdict == "correct",
            now,
            float(part.verdict.credit),
            helped=False,
            attempt=f"{sitting}/{number}",
        )
        for number, question in enumerate(results.questions, start=1)
        for part in question.parts
        if part.status != "open"
    )
