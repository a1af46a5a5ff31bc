"""Marking what came back: every part by machine, then what people decided of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

import msgspec

from quizgen.classes.rulings import (
    ACCEPT,
    DECIDE,
    DROP,
    GIVE,
    TOLERANCE,
    Ruling,
    RulingBook,
    answer_group,
    fold_answer,
)
from quizgen.core.errors import ClassError, KeyFileError
from quizgen.grading.options import GradingOptions
from quizgen.kinds.asking import LETTERS
from quizgen.locale import fallback_language
from quizgen.maths.tolerance import RULES
from quizgen.paper.answer_key import AnswerKey, KeyPart, KeyQuestion
from quizgen.paper.grading import PartResult, QuestionGrader

TO_DECIDE = frozenset({"open", "unreadable", "ambiguous"})
"""What a person is asked about."""
DROPPED = "dropped"


@dataclass(frozen=True)
class Submission:
    """What one student handed in.

    Parameters
    ----------
    student : str
        The id.
    answers : mapping of str to str
        Part to what was typed.
    lang, decimal : str
        How the student writes.
    file : str
        Where it stands.
    minutes : float, optional
        Time that was taken, where it is known.
    """

    student: str
    answers: Mapping[str, str]
    lang: str = ""
    decimal: str = "auto"
    file: str = ""
    minutes: float | None = None


class GradedClassPart(msgspec.Struct, frozen=True, omit_defaults=True):
    """The mark of one part.

    ``marks`` is None while nobody has decided. ``by`` says which ruling gave the marks, ``remark``
    what it tells the student, ``group`` with which answers it is decided together, ``chosen`` which
    options were ticked.
    """

    id: str
    item: str
    typed: str
    status: str
    points: float
    marks: float | None
    note: str = ""
    by: str = ""
    remark: str = ""
    group: str = ""
    chosen: tuple[str, ...] = ()

    @property
    def share(self) -> float | None:
        """Return the marks as a share of the points; None if undecided or dropped."""
        return None if self.marks is None or not self.points else self.marks / self.points

    @property
    def needs_decision(self) -> bool:
        """Whether a person must decide the marks."""
        return self.marks is None


class StudentMarks(msgspec.Struct, frozen=True, omit_defaults=True):
    """All marks of one student: a line of the grading history."""

    student: str
    parts: tuple[GradedClassPart, ...]
    lang: str = ""
    decimal: str = "auto"
    file: str = ""
    minutes: float | None = None
    unknown: tuple[str, ...] = ()

    @property
    def marks(self) -> float:
        """Return the sum of the marks decided so far."""
        return sum(part.marks or 0.0 for part in self.parts)

    @property
    def points(self) -> float:
        """Return the most marks the student can have."""
        return sum(part.points for part in self.parts)

    @property
    def undecided_count(self) -> int:
        """Return the number of parts that a person must decide."""
        return sum(part.needs_decision for part in self.parts)


def item_name(question: KeyQuestion, part: KeyPart) -> str:
    """Return a part's name in all papers of a class: template, and ``/label`` if it has one."""
    return item_name_from_parts(question.template, question.number, part.id)


@lru_cache(maxsize=4096)
def item_name_from_parts(template: str, number: str, part: str) -> str:
    """Return the item name ``template/label`` that a part has in all papers of a class.

    ``part`` is its id on the paper, such as ``3b`` in question ``number`` 3.
    """
    label = part.removeprefix(number)
    return f"{template}/{label}" if label else template


def grade_submission(key: AnswerKey, sheet: Submission, book: RulingBook) -> StudentMarks:
    """Return the marks of a submission, with all rulings applied.

    Parameters
    ----------
    key : AnswerKey
        Of the student's own paper.
    sheet : Submission
    book : RulingBook
        What was decided.

    Raises
    ------
    ClassError
        If a tolerance was ruled where there is none.
    KeyFileError
        If the key is wrong.
    """
    lang = fallback_language(sheet.lang or key.langs[0])
    options = GradingOptions(lang, sheet.decimal)
    parts = [
        one
        for question in key.questions
        for one in _iter_graded_parts(question, sheet, book, options)
    ]
    mine = {part.id for part in parts}
    unknown = tuple(n for n, text in sheet.answers.items() if n not in mine and text.strip())
    return StudentMarks(
        sheet.student, tuple(parts), lang, sheet.decimal, sheet.file, sheet.minutes, unknown
    )


def _iter_graded_parts(
    question: KeyQuestion, sheet: Submission, book: RulingBook, options: GradingOptions
) -> Iterator[GradedClassPart]:
    """Yield each part of a question graded, with its rulings applied."""
    marker = QuestionGrader(question, options, proven=True)
    for part in question.parts:
        item, typed = item_name(question, part), sheet.answers.get(part.id, "")
        rulings = book.rulings_for(item, sheet.student)
        if not typed.strip():
            blank = GradedClassPart(part.id, item, typed, "blank", float(part.points_exact()), 0.0)
            yield _apply_rulings(blank, [one for one in rulings if one.what in {DROP, GIVE}])
            continue
        found = marker.judge_part(_with_tolerance(part, item, rulings), typed)
        yield _apply_decisions(found, part, item, rulings)


def _with_tolerance(part: KeyPart, item: str, rulings: Iterable[Ruling]) -> KeyPart:
    """Return the part with the tolerance of the last ruling about one; unchanged without."""
    stated = [one.tolerance() for one in rulings if one.what == TOLERANCE]
    if not stated:
        return part
    kept = {name: value for name, value in part.spec.items() if name not in {*RULES, "within"}}
    ruled = msgspec.structs.replace(part, spec={**kept, **stated[-1]})
    try:
        ruled.parse_spec()
    except KeyFileError as error:
        raise ClassError(f"rulings: {item}: no tolerance holds there: {error}") from None
    return ruled


def _apply_decisions(
    found: PartResult, part: KeyPart, item: str, rulings: list[Ruling]
) -> GradedClassPart:
    """Return the mark of an answer after the rulings about it."""
    asked = found.status in TO_DECIDE
    words = part.spec["kind"] == "rubric"
    group = ""
    if asked or rulings:
        group = answer_group(item, part.parse_spec(proven=True).show(), found.typed, words=words)
    plain = GradedClassPart(
        found.id,
        item,
        found.typed,
        found.status,
        float(found.points),
        None if asked else float(found.marks or 0),
        found.verdict.note,
        group=group if asked else "",
        chosen=_list_ticked_options(part, found),
    )
    return _apply_rulings(
        plain, [one for one in rulings if _is_ruling_about(one, found, group, words=words)]
    )


def _apply_rulings(plain: GradedClassPart, rulings: list[Ruling]) -> GradedClassPart:
    """Return the mark after its rulings: those for the whole item outrank those for answers."""
    whole = [one for one in rulings if one.what in {DROP, GIVE}]
    answers = [one for one in rulings if one.what in {DECIDE, ACCEPT}]
    tolerances = [one for one in rulings if one.what == TOLERANCE]
    if whole and whole[-1].what == DROP:
        return _apply_ruling(whole[-1], plain, marks=0.0, points=0.0, status=DROPPED)
    if whole:
        return _apply_ruling(whole[-1], plain, marks=plain.points)
    if answers and not answers[-1].is_revoked:
        given = answers[-1].points
        marks = plain.points if given is None else min(float(given), plain.points)
        return _apply_ruling(answers[-1], plain, marks=marks)
    return _apply_ruling(tolerances[-1], plain) if tolerances else plain


def _apply_ruling(
    ruling: Ruling, plain: GradedClassPart, **changed: float | str
) -> GradedClassPart:
    """Return the mark changed by a ruling, with the ruling's author and comment."""
    known = {"by": ruling.describe, "remark": ruling.comment, **changed}
    return msgspec.structs.replace(plain, **known)


def _is_ruling_about(ruling: Ruling, found: PartResult, group: str, *, words: bool) -> bool:
    """Return whether a ruling concerns this answer.

    ``words``: the answer is a sentence, in which capitals do not matter.
    """
    if ruling.what in {DROP, GIVE, TOLERANCE}:
        return True
    if ruling.group:
        return ruling.group == group
    if ruling.answer.startswith("trap:"):
        return found.verdict.note == ruling.answer
    return fold_answer(ruling.answer, words=words) == fold_answer(found.typed, words=words)


def _list_ticked_options(part: KeyPart, found: PartResult) -> tuple[str, ...]:
    """Return the texts of the ticked options: their letters differ from paper to paper."""
    kind, verdict = part.spec["kind"], found.verdict
    if kind not in {"choice", "multi", "tf"} or not verdict.is_graded:
        return ()
    if kind == "tf":
        return (verdict.read_as,)
    options: list[str] = part.spec.get("options", [])
    return tuple(options[LETTERS.index(c)] for c in verdict.read_as if c in LETTERS)
