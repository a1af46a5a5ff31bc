"""Marking what came back: every part by machine, then what people decided of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from itertools import accumulate

import msgspec

from quizgen.classes.grade_scale import GradeScale
from quizgen.classes.rulings import (
    ACCEPT,
    ALWAYS,
    DECIDE,
    DROP,
    GIVE,
    POINTS,
    TOLERANCE,
    TRAP,
    Ruling,
    RulingBook,
    answer_group,
    blank_group,
    fold_answer,
    is_on_paper,
)
from quizgen.core.errors import ClassError, KeyFileError
from quizgen.grading.options import GradingOptions
from quizgen.kinds.asking import LETTERS
from quizgen.locale import fallback_language
from quizgen.maths.tolerance import RULES
from quizgen.paper.answer_key import AnswerKey, KeyPart, KeyQuestion
from quizgen.paper.grading import PartResult, QuestionGrader

UNREAD = "unreadable"
TO_DECIDE = frozenset({"open", UNREAD, "ambiguous"})
"""What a person is asked about."""
DROPPED = "dropped"
KEPT = "kept: better with it"
WHOLE = frozenset({DROP, GIVE, POINTS})
"""Rulings that hold whatever was typed, or if nothing was."""


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
    seconds : mapping of str to float
        Number of a question to the time for which a browser showed it.
    """

    student: str
    answers: Mapping[str, str]
    lang: str = ""
    decimal: str = "auto"
    file: str = ""
    minutes: float | None = None
    seconds: Mapping[str, float] = field(default_factory=dict)


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


class JudgedPart(msgspec.Struct, frozen=True):
    """What the machine says of a part before anybody has decided anything.

    ``group`` names the answers that are equal to it, ``words`` says that it is a sentence.
    """

    plain: GradedClassPart
    group: str
    words: bool = False


class JudgedSubmission(msgspec.Struct, frozen=True):
    """What the machine says of all that a student handed in, in the language it was read in."""

    lang: str
    parts: tuple[JudgedPart, ...]


class StudentMarks(msgspec.Struct, frozen=True, omit_defaults=True):
    """All marks of one student: a line of the grading history."""

    student: str
    parts: tuple[GradedClassPart, ...]
    lang: str = ""
    decimal: str = "auto"
    file: str = ""
    minutes: float | None = None
    seconds: dict[str, float] = {}

    @property
    def filled_count(self) -> int:
        """Return the number of parts in which something was written."""
        return sum(bool(part.typed.strip()) for part in self.parts)

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


def question_number(part: str, item: str) -> str:
    """Return the number of the question of a part: ``3`` for ``3b``, which is ``b`` of its item."""
    return part.removesuffix(item.partition("/")[2])


def grade_submission(
    key: AnswerKey, sheet: Submission, book: RulingBook, scale: GradeScale | None = None
) -> StudentMarks:
    """Return the marks of a submission, with all rulings applied.

    Parameters
    ----------
    key : AnswerKey
        Of the student's own paper.
    sheet : Submission
    book : RulingBook
        What was decided.
    scale : GradeScale, optional
        How points are rounded, on which depends whom a dropped item would harm.

    Raises
    ------
    ClassError
        If a tolerance was ruled where there is none.
    KeyFileError
        If the key is wrong.
    """
    return apply_rulings(judge_submission(key, sheet, book), sheet, book, scale or GradeScale())


def judge_submission(key: AnswerKey, sheet: Submission, book: RulingBook) -> JudgedSubmission:
    """Return what the machine says of a submission; of all rulings it knows tolerances alone.

    Raises
    ------
    ClassError
        If a tolerance was ruled where there is none.
    KeyFileError
        If the key is wrong.
    """
    lang = fallback_language(sheet.lang or key.langs[0])
    options = GradingOptions(lang, sheet.decimal)
    parts = tuple(
        one
        for question in key.questions
        for one in _iter_judged_parts(question, sheet, book, options)
    )
    return JudgedSubmission(lang, parts)


def apply_rulings(
    judged: JudgedSubmission, sheet: Submission, book: RulingBook, scale: GradeScale
) -> StudentMarks:
    """Return the marks of a submission that was judged, after what people decided."""
    parts = [_apply_decisions(one, book, sheet.student) for one in judged.parts]
    return StudentMarks(
        sheet.student,
        tuple(_drop_items(parts, book, sheet.student, scale)),
        judged.lang,
        sheet.decimal,
        sheet.file,
        sheet.minutes,
        dict(sheet.seconds),
    )


def _drop_items(
    parts: list[GradedClassPart], book: RulingBook, student: str, scale: GradeScale
) -> list[GradedClassPart]:
    """Return the parts after items were dropped: each only where it does not harm the student.

    Of the shares of the points that are reached with the best of the dropped items, with the best
    two, and so on, the largest counts; with none and with all of them are among these.
    """
    dropped = {part.item: ruling for part in parts
               if (ruling := book.find_drop(part.item, student)) is not None}  # fmt: skip
    if not dropped:
        return parts
    rest = [part for part in parts if part.item not in dropped]
    own = [p for p in parts if p.item in dropped and p.marks and dropped[p.item].value != ALWAYS]
    own.sort(key=lambda part: -Fraction(part.marks or 0) / Fraction(part.points))
    steps = accumulate(own, lambda before, part: [*before, part], initial=list[GradedClassPart]())
    best = max(steps, key=lambda kept: (_compute_share([*rest, *kept], scale), -len(kept)))
    kept = {part.item for part in best}
    return [_drop_item(part, dropped[part.item], kept) if part.item in dropped else part
            for part in parts]  # fmt: skip


def _compute_share(parts: Iterable[GradedClassPart], scale: GradeScale) -> Fraction:
    """Return the share of the points (0 to 1) that is reached, rounded as for the grade."""
    marks = sum((Fraction(part.marks or 0) for part in parts), Fraction(0))
    points = sum((Fraction(part.points) for part in parts), Fraction(0))
    return scale.round_points(marks) / points if points else Fraction(0)


def _drop_item(part: GradedClassPart, ruling: Ruling, kept: set[str]) -> GradedClassPart:
    """Return a part whose item is dropped; if it is among those kept, only with who said so."""
    if part.item in kept:
        return _apply_ruling(ruling, part, by=f"{ruling.describe}, {KEPT}")
    return _apply_ruling(ruling, part, marks=0.0, points=0.0, status=DROPPED, group="")


def _iter_judged_parts(
    question: KeyQuestion, sheet: Submission, book: RulingBook, options: GradingOptions
) -> Iterator[JudgedPart]:
    """Yield each part of a question as the machine judges it."""
    marker = QuestionGrader(question, options, proven=True)
    for part in question.parts:
        item, typed = item_name(question, part), sheet.answers.get(part.id, "")
        if not typed.strip():
            blank = GradedClassPart(part.id, item, typed, "blank", float(part.points_exact()), 0.0)
            yield JudgedPart(blank, blank_group(item, sheet.student))
            continue
        rulings = book.rulings_for(item, sheet.student)
        found = marker.judge_part(replace_tolerance(part, item, rulings), typed)
        yield _describe_judged_part(found, part, item, sheet.student)


def replace_tolerance(part: KeyPart, item: str, rulings: Iterable[Ruling]) -> KeyPart:
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


def stands_alone(kind: str, typed: str) -> bool:
    """Return whether equal words of two students may stand for different answers.

    Those that describe a drawing, or say that the answer is on paper.
    """
    return kind == "sketch" or is_on_paper(typed)


def _describe_judged_part(found: PartResult, part: KeyPart, item: str, student: str) -> JudgedPart:
    """Return a part that was filled in as the machine judges it."""
    unseen = not found.marks and is_on_paper(found.typed)  # to a gap the words are a wrong term
    asked = unseen or found.status in TO_DECIDE
    kind = part.spec["kind"]
    words = kind == "rubric"
    shown = part.parse_spec(proven=True).show()
    whose = f"\0{student}" if stands_alone(kind, found.typed) else ""
    plain = GradedClassPart(
        found.id,
        item,
        found.typed,
        UNREAD if unseen and found.status not in TO_DECIDE else found.status,
        float(found.points),
        None if asked else float(found.marks or 0),
        found.verdict.note,
        chosen=_list_ticked_options(part, found),
    )
    return JudgedPart(plain, answer_group(item, shown + whose, found.typed, words=words), words)


def _apply_decisions(judged: JudgedPart, book: RulingBook, student: str) -> GradedClassPart:
    """Return the mark of a part after the rulings about it."""
    plain = judged.plain
    rulings = book.rulings_for(plain.item, student)
    if plain.status == "blank":
        about = [one for one in rulings if one.what in WHOLE or one.group == judged.group]
        return _apply_rulings(plain, about)
    if plain.needs_decision:
        plain = msgspec.structs.replace(plain, group=judged.group)
    return _apply_rulings(plain, [one for one in rulings if _is_ruling_about(one, judged)])


def _apply_rulings(plain: GradedClassPart, rulings: list[Ruling]) -> GradedClassPart:
    """Return the mark after its rulings: those for the whole item outrank those for answers.

    A dropped item is seen to where all parts of the student are known.
    """
    whole = [one for one in rulings if one.what in {GIVE, POINTS}]
    if whole:
        given = plain.points if whole[-1].what == GIVE else _limit_points(whole[-1], plain)
        return _apply_ruling(whole[-1], plain, marks=given)
    found = plain
    for one in sorted(rulings, key=lambda one: one.what != TOLERANCE):
        if one.what == TOLERANCE:
            found = _apply_ruling(one, found)
        elif one.is_revoked:
            found = plain
        elif one.what in {DECIDE, ACCEPT}:
            given = _limit_points(one, plain)
            if one.what == DECIDE or found.marks is None or given > found.marks:
                found = _apply_ruling(one, found, marks=given)
    return found


def _limit_points(ruling: Ruling, part: GradedClassPart) -> float:
    """Return the points that a ruling gives, all where it names none."""
    given = ruling.points
    return part.points if given is None else min(float(given), part.points)


def _apply_ruling(
    ruling: Ruling, plain: GradedClassPart, **changed: float | str
) -> GradedClassPart:
    """Return the mark changed by a ruling, with the ruling's author and comment."""
    known = {"by": ruling.describe, "remark": ruling.comment, **changed}
    return msgspec.structs.replace(plain, **known)


def _is_ruling_about(ruling: Ruling, judged: JudgedPart) -> bool:
    """Return whether a ruling concerns an answer; in a sentence capitals do not matter."""
    if ruling.what in {*WHOLE, TOLERANCE}:
        return True
    if ruling.group:
        return ruling.group == judged.group
    if ruling.answer.startswith(TRAP):
        return judged.plain.note == ruling.answer
    typed = fold_answer(judged.plain.typed, words=judged.words)
    return fold_answer(ruling.answer, words=judged.words) == typed


def _list_ticked_options(part: KeyPart, found: PartResult) -> tuple[str, ...]:
    """Return the texts of the ticked options: their letters differ from paper to paper."""
    kind, verdict = part.spec["kind"], found.verdict
    if kind not in {"choice", "multi", "tf"} or not verdict.is_graded:
        return ()
    if kind == "tf":
        return (verdict.read_as,)
    options: list[str] = part.spec.get("options", [])
    return tuple(options[LETTERS.index(c)] for c in verdict.read_as if c in LETTERS)
