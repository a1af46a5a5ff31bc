"""Showing marked attempts: a line for each and a line for each question, CSV and JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from statistics import correlation, fmean

from quizgen.columns import lay_out_table
from quizgen.core.untrusted import escape_control_characters, format_csv
from quizgen.locale import localise_numbers
from quizgen.paper.grade_report import format_points, part_note
from quizgen.paper.grading import PartResult
from quizgen.responses.marks import Marked

HEAD = ("where", "name", "id", "email", "attempt", "marks", "points", "asked_back", "to_decide")
USUAL_NOTES = 3
"""Mistakes of a question that are named."""
FEWEST = 3
"""Attempts below which no correlation is told."""


@dataclass(frozen=True, slots=True)
class Statistics:
    """A question of a quiz over all attempts, whichever variants they had.

    Parameters
    ----------
    number : str
    count : int
        Attempts in which it was asked.
    share : float
        Marks that were given for it, of those that could be had.
    apart : float, optional
        How well it tells those apart who are good at the other questions: the correlation of its
        marks with all others.
    notes : list
        What went wrong most often, and how often.
    """

    number: str
    count: int
    share: float
    apart: float | None
    notes: list[tuple[str, int]]


def by_question(one: Marked) -> dict[str, list[PartResult]]:
    """The parts of each question of an attempt."""
    found: dict[str, list[PartResult]] = {}
    for part in one.result.parts:
        found.setdefault(part.number, []).append(part)
    return found


def statistics(marked: Sequence[Marked]) -> Iterator[Statistics]:
    """The questions of a quiz in their order."""
    split = [by_question(one) for one in marked]
    for number in dict.fromkeys(number for one in split for number in one):
        asked = [(one, found[number]) for one, found in zip(marked, split, strict=True)
                 if number in found]  # fmt: skip
        shares = [_share(parts) for _, parts in asked]
        others = [float(one.result.marks - _marks(parts)) for one, parts in asked]
        wrong = (part_note(part) for _, parts in asked for part in parts if _missed(part))
        notes = Counter(wrong).most_common(USUAL_NOTES)
        yield Statistics(number, len(asked), fmean(shares), _correlated(shares, others), notes)


def _missed(part: PartResult) -> bool:
    return part.marks is not None and part.verdict.credit < 1 and not part.is_blank


def _marks(parts: Sequence[PartResult]) -> Fraction:
    return sum((part.marks or Fraction(0) for part in parts), Fraction(0))


def _share(parts: Sequence[PartResult]) -> float:
    return float(_marks(parts) / sum(part.points for part in parts))


def _correlated(shares: Sequence[float], others: Sequence[float]) -> float | None:
    """The correlation, where there is one: not for few, nor for all the same."""
    if len(shares) < FEWEST or len({*shares}) < 2 or len({*others}) < 2:
        return None
    return correlation(shares, others)


def as_csv(marked: Sequence[Marked]) -> str:
    """One row for each attempt: which question stood where, marks and notes of every part."""
    numbers = list(dict.fromkeys(number for one in marked for number in one.questions))
    parts = list(dict.fromkeys(part.id for one in marked for part in one.result.parts))
    titles = [f"{number} question" for number in numbers]
    titles += [f"{part} {what}" for what in ("typed", "marks", "note") for part in parts]
    return format_csv([(*HEAD, *titles), *(_attempt(one, numbers, parts) for one in marked)])


def _attempt(one: Marked, numbers: Sequence[str], parts: Sequence[str]) -> list[str]:
    found = {part.id: part for part in one.result.parts}
    row = [*_person(one), *(one.questions.get(number, "") for number in numbers)]
    for shown in (_typed, _given, part_note):
        row += [shown(found[part]) if part in found else "" for part in parts]
    return row


def _person(one: Marked) -> list[str]:
    attempt, result = one.attempt, one.result
    totals = (format_points(result.marks), format_points(result.points))
    counts = (one.number, result.asked_back, result.to_decide)
    number, asked_back, to_decide = map(str, counts)
    known = [attempt.where, attempt.name, attempt.id, attempt.email, number]
    return [*known, *totals, asked_back, to_decide]


def _typed(part: PartResult) -> str:
    return part.typed


def _given(part: PartResult) -> str:
    return "" if part.marks is None else format_points(part.marks)


def as_json(one: Marked) -> dict[str, object]:
    """Plain values for JSON."""
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


def lines(marked: Sequence[Marked], lang: str) -> Iterator[str]:
    """A table of attempts and one of questions, their numbers as in a language."""
    found = [_row(one, lang) for one in marked]
    yield from _lay_out([("name", "id", "marks", "asked back", "to decide"), *found])
    yield ""
    found = [_question(one, lang) for one in statistics(marked)]
    yield from _lay_out([("question", "asked", "marks", "r", "most often"), *found])


def _row(one: Marked, lang: str) -> tuple[str, ...]:
    result = one.result
    again = f" ({one.number})" if one.number > 1 else ""
    marks = localise_numbers(
        lang, f"{format_points(result.marks)} / {format_points(result.points)}"
    )
    name = escape_control_characters(one.attempt.name) + again
    return (
        name,
        escape_control_characters(one.attempt.who[0]),
        marks,
        str(result.asked_back),
        str(result.to_decide),
    )


def _question(one: Statistics, lang: str) -> tuple[str, ...]:
    apart = "" if one.apart is None else localise_numbers(lang, f"{one.apart:.2f}")
    notes = ", ".join(f"{count} {name}" for name, count in one.notes)
    return (escape_control_characters(one.number), str(one.count), f"{one.share:.0%}", apart, notes)


def _lay_out(rows: Sequence[tuple[str, ...]]) -> Iterator[str]:
    return (line for lines in lay_out_table(rows) for line in lines)
