"""A paper that was handed in: marks, what was said of each part, what to practise."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from quizgen.bank.folder import Bank
from quizgen.marking.options import Options
from quizgen.marking.verdict import Verdict
from quizgen.paper.marking import Marker, PartResult, in_quarters
from quizgen.practice.boxes import joined
from quizgen.practice.schedule import Asked, Grade
from quizgen.web.made import Made, MadePaper, MadePart
from quizgen.web.store import Seen
from quizgen.web.unread import Unread, unread

WRONG = frozenset({"wrong", "partial"})


@dataclass(frozen=True)
class Marked:
    """One part of a paper that was handed in."""

    part: MadePart
    values: Sequence[str]
    """What stands in its fields."""
    result: PartResult
    own: float | None
    """The share of its points that the learner gave it, where a person has to decide."""
    lang: str

    @property
    def verdict(self) -> Verdict:
        """What the checker says."""
        return self.result.verdict

    @property
    def unread(self) -> Unread | None:
        """Why it could not be read, if it could not."""
        if self.verdict.graded or self.verdict.self_marked:
            return None
        return unread(self.part.field, self.values, self.verdict, self.lang)

    @property
    def marks(self) -> Fraction | None:
        """Its marks; None while nobody has decided."""
        if self.result.blank:
            return Fraction(0)
        if self.result.marks is None and self.own is not None:
            return in_quarters(Fraction(str(self.own)) * self.result.points)
        return self.result.marks

    @property
    def status(self) -> str:
        """``blank``, ``open``, ``judged`` or the verdict."""
        if self.result.status == "open":
            return "open" if self.own is None else "judged"
        return self.result.status


@dataclass(frozen=True)
class Question:
    """One question of a paper that was handed in."""

    made: Made
    parts: tuple[Marked, ...]

    @property
    def marks(self) -> Fraction:
        """Marks so far."""
        return sum((part.marks or Fraction(0) for part in self.parts), Fraction(0))

    @property
    def points(self) -> Fraction:
        """Marks that can be had."""
        return sum((part.result.points for part in self.parts), Fraction(0))

    @property
    def weak(self) -> bool:
        """Whether it is worth practising."""
        return self.marks < self.points


@dataclass(frozen=True)
class Results:
    """A paper that was handed in."""

    questions: tuple[Question, ...]

    @property
    def marks(self) -> Fraction:
        """Marks so far."""
        return sum((question.marks for question in self.questions), Fraction(0))

    @property
    def points(self) -> Fraction:
        """Marks that can be had."""
        return sum((question.points for question in self.questions), Fraction(0))

    @property
    def to_judge(self) -> int:
        """Sentences that nobody has decided on."""
        return sum(part.status == "open" for q in self.questions for part in q.parts)

    def mistakes(self) -> list[tuple[str, list[Made]]]:
        """What was said of wrong parts, with the questions, those of most questions first."""
        found: dict[str, list[Made]] = {}
        for question in self.questions:
            for part in question.parts:
                graded = part.status in WRONG and part.verdict.note
                if graded and question.made not in found.setdefault(part.verdict.message, []):
                    found[part.verdict.message].append(question.made)
        return sorted(found.items(), key=lambda one: -len(one[1]))


def marked(paper: MadePaper, answers: Mapping[str, list[str]], own: Mapping[str, float]) -> Results:
    """Mark a paper.

    Parameters
    ----------
    paper : MadePaper
    answers : mapping
        Part to what stands in its fields.
    own : mapping
        Part to the share that the learner gave it.
    """
    return Results(tuple(_question(item, answers, own) for item in paper.items))


def _question(item: Made, answers: Mapping[str, list[str]], own: Mapping[str, float]) -> Question:
    lang = item.wanted.lang
    marker = Marker(item.key, Options(lang))
    parts = []
    for part, keyed in zip(item.parts, item.key.parts, strict=True):
        field = part.field
        values = answers.get(field.id, ())
        typed = joined(field.control, values, field.marks)
        parts.append(Marked(part, values, marker.mark(keyed, typed), own.get(field.id), lang))
    return Question(item, tuple(parts))


def asked(bank: Bank, results: Results) -> list[Asked]:
    """What a paper says of its templates; nothing of questions that a person has to mark."""
    found = []
    for question in results.questions:
        parts = [part for part in question.parts if part.status != "open"]
        if parts:
            right = all(part.verdict.verdict == "correct" for part in parts)
            notes = tuple(part.verdict.note for part in parts if part.status in WRONG)
            origin = bank.origin(question.made.wanted.template)
            found.append(Asked(origin, Grade.GOOD if right else Grade.AGAIN, notes))
    return found


def outcomes(results: Results) -> tuple[Seen, ...]:
    """How the parts went, for what to practise next; blank ones were not right."""
    now = time.time()
    return tuple(
        Seen(
            question.made.wanted.template,
            question.made.topic,
            part.part.label,
            part.verdict.note if part.status in WRONG else "",
            part.verdict.verdict == "correct",
            part.verdict.verdict == "correct",
            now,
        )
        for question in results.questions
        for part in question.parts
        if part.status != "open"
    )
