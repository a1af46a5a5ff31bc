"""Reports of graded attempts: a line for each attempt and each question, CSV and JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from statistics import correlation, fmean

from quizgen.core.text_width import lay_out_table
from quizgen.core.untrusted import escape_control_characters, format_csv
from quizgen.lms.grading import GradedAttempt
from quizgen.locale import localise_numbers
from quizgen.paper.grade_report import format_points, part_note
from quizgen.paper.grading import PartResult

HEAD = ("where", "name", "id", "email", "attempt", "marks", "points", "asked_back", "to_decide")
# Mistakes of a question that are named.
NOTE_COUNT = 3
# With fewer attempts no correlation is shown.
FEWEST_ATTEMPTS = 3


@dataclass(frozen=True, slots=True)
class QuestionStatistics:
    """A question of a quiz over all attempts and variants.

    Parameters
    ----------
    number : str
    count : int
        Attempts in which it was asked.
    share : float
        Mean of its marks, 1 for all.
    correlation : float, optional
        Of its marks with those of all other questions (item-rest r).
    notes : list
        The most frequent mistakes, and how often each was made.
    """

    number: str
    count: int
    share: float
    correlation: float | None
    notes: list[tuple[str, int]]


def group_by_question(one: GradedAttempt) -> dict[str, list[PartResult]]:
    """Return the parts of an attempt by the number of their question."""
    found: dict[str, list[PartResult]] = {}
    for part in one.result.parts:
        found.setdefault(part.number, []).append(part)
    return found


def question_statistics(marked: Sequence[GradedAttempt]) -> Iterator[QuestionStatistics]:
    """Yield the statistics of the questions of a quiz, in their order."""
    split = [group_by_question(one) for one in marked]
    for number in dict.fromkeys(number for one in split for number in one):
        asked = [(one, found[number]) for one, found in zip(marked, split, strict=True)
                 if number in found]  # fmt: skip
        shares = [_score_share(parts) for _, parts in asked]
        others = [float(one.result.marks - _sum_marks(parts)) for one, parts in asked]
        wrong = (part_note(part) for _, parts in asked for part in parts if _is_missed(part))
        notes = Counter(wrong).most_common(NOTE_COUNT)
        rest = _item_rest_correlation(shares, others)
        yield QuestionStatistics(number, len(asked), fmean(shares), rest, notes)


def _is_missed(part: PartResult) -> bool:
    """Return whether a part was answered and did not earn all its marks."""
    return part.marks is not None and part.verdict.credit < 1 and not part.is_blank


def _sum_marks(parts: Sequence[PartResult]) -> Fraction:
    """Return the marks of some parts together; an undecided part counts 0."""
    return sum((part.marks or Fraction(0) for part in parts), Fraction(0))


def _score_share(parts: Sequence[PartResult]) -> float:
    """Return the marks of some parts as a share of their points, 0 to 1."""
    return float(_sum_marks(parts) / sum(part.points for part in parts))


def _item_rest_correlation(shares: Sequence[float], others: Sequence[float]) -> float | None:
    """Return the item-rest correlation; None for few attempts, or if all are equal."""
    if len(shares) < FEWEST_ATTEMPTS or len({*shares}) < 2 or len({*others}) < 2:
        return None
    return correlation(shares, others)


def attempts_to_csv(marked: Sequence[GradedAttempt]) -> str:
    """Return a row for each attempt: its questions by number, marks and notes of every part."""
    numbers = list(dict.fromkeys(number for one in marked for number in one.questions))
    parts = list(dict.fromkeys(part.id for one in marked for part in one.result.parts))
    titles = [f"{number} question" for number in numbers]
    titles += [f"{part} {what}" for what in ("typed", "marks", "note") for part in parts]
    return format_csv([(*HEAD, *titles), *(_attempt_row(one, numbers, parts) for one in marked)])


def _attempt_row(one: GradedAttempt, numbers: Sequence[str], parts: Sequence[str]) -> list[str]:
    """Return the cells of an attempt, in the order of the table's columns."""
    found = {part.id: part for part in one.result.parts}
    row = [*_person_cells(one), *(one.questions.get(number, "") for number in numbers)]
    for shown in (_typed_cell, _marks_cell, part_note):
        row += [shown(found[part]) if part in found else "" for part in parts]
    return row


def _person_cells(one: GradedAttempt) -> list[str]:
    """Return the cells that say who made an attempt, and its totals."""
    attempt, result = one.attempt, one.result
    totals = (format_points(result.marks), format_points(result.points))
    counts = (one.number, result.asked_back, result.to_decide)
    number, asked_back, to_decide = map(str, counts)
    known = [attempt.where, attempt.name, attempt.id, attempt.email, number]
    return [*known, *totals, asked_back, to_decide]


def _typed_cell(part: PartResult) -> str:
    """Return the text that was typed for a part, for a cell of the table."""
    return part.typed


def _marks_cell(part: PartResult) -> str:
    """Return the marks of a part; empty if a person must decide them."""
    return "" if part.marks is None else format_points(part.marks)


def attempt_to_json(one: GradedAttempt) -> dict[str, object]:
    """Return plain values for JSON."""
    attempt = one.attempt
    return {
        "where": attempt.where,
        "name": attempt.name,
        "id": attempt.id,
        "email": attempt.email,
        "attempt": one.number,
        "questions": dict(one.questions),
        "foreign": list(one.foreign),
        **one.result.as_json(),
    }


def format_attempts(marked: Sequence[GradedAttempt], lang: str) -> Iterator[str]:
    """Yield a table of attempts and one of questions, with the digits of a language."""
    found = [_attempt_line(one, lang) for one in marked]
    yield from _format_table([("name", "id", "marks", "asked back", "to decide"), *found])
    yield ""
    found = [_question_line(one, lang) for one in question_statistics(marked)]
    yield from _format_table([("question", "asked", "marks", "r", "most often"), *found])


def _attempt_line(one: GradedAttempt, lang: str) -> tuple[str, ...]:
    """Return the cells of an attempt, for a terminal in a language."""
    result = one.result
    again = f" ({one.number})" if one.number > 1 else ""
    marks = localise_numbers(
        lang, f"{format_points(result.marks)} / {format_points(result.points)}"
    )
    name = escape_control_characters(one.attempt.name) + again
    return (
        name,
        escape_control_characters(one.attempt.person_key[0]),
        marks,
        str(result.asked_back),
        str(result.to_decide),
    )


def _question_line(one: QuestionStatistics, lang: str) -> tuple[str, ...]:
    """Return the cells of a question's statistics, for a terminal in a language."""
    rest = "" if one.correlation is None else localise_numbers(lang, f"{one.correlation:.2f}")
    notes = ", ".join(f"{count} {name}" for name, count in one.notes)
    return (escape_control_characters(one.number), str(one.count), f"{one.share:.0%}", rest, notes)


def _format_table(rows: Sequence[tuple[str, ...]]) -> Iterator[str]:
    """Yield the lines of a table with aligned columns."""
    return (line for lines in lay_out_table(rows) for line in lines)
