"""What the marks of a class say about its questions."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from quizgen.classes.effects import Draws, Effect
from quizgen.classes.keys import Outline
from quizgen.classes.mark import DROPPED, Marks, PartMark
from quizgen.classes.statistics import Table, alpha, alpha_interval, rest_correlation

WRONG = frozenset({"wrong", "partial"})


@dataclass(frozen=True)
class Example:
    """Somebody whose answer shows a mistake."""

    student: str
    part: str
    typed: str


@dataclass(frozen=True)
class Mistake:
    """A mistake with a name, and how many made it."""

    note: str
    students: int
    example: Example


@dataclass(frozen=True)
class ItemFigures:
    """One item.

    Parameters
    ----------
    item : str
    students : int
        Whose points are known.
    points : float
    difficulty : float or None
        Mean share of the points: 1 is easy.
    discrimination : float or None
        Correlation with the points of all other items.
    blank, undecided : int
        Students.
    mistakes : tuple of Mistake
        The most frequent first.
    options : tuple of (str, int, int)
        Option, how many had it, how many chose it; the least chosen first.
    """

    item: str
    students: int
    points: float
    difficulty: float | None
    discrimination: float | None
    blank: int
    undecided: int
    mistakes: tuple[Mistake, ...]
    options: tuple[tuple[str, int, int], ...]

    @property
    def never(self) -> list[str]:
        """Options that nobody chose."""
        return [name for name, had, chosen in self.options if had and not chosen]


@dataclass(frozen=True)
class Analysis:
    """A class.

    Parameters
    ----------
    students : int
    totals : tuple of float
        Points of each.
    points : float
        The most that anybody can have.
    minutes : tuple of float
        Working times that are known.
    questions : int
        From how many alpha is computed.
    alpha : float or None
        Cronbach's, over whole questions: parts of one lean on each other.
    interval : tuple of float or None
        Feldt's, 95 %.
    items : tuple of ItemFigures
    effects : tuple of Effect
    """

    students: int
    totals: tuple[float, ...]
    points: float
    minutes: tuple[float, ...]
    questions: int
    alpha: float | None
    interval: tuple[float, float] | None
    items: tuple[ItemFigures, ...]
    effects: tuple[Effect, ...]


class _Counts:
    """What is counted of one item."""

    def __init__(self) -> None:
        self.points = 0.0
        self.blank = self.undecided = 0
        self.notes: Counter[str] = Counter()
        self.examples: dict[str, Example] = {}
        self.had: Counter[str] = Counter()
        self.chosen: Counter[str] = Counter()

    def add(self, part: PartMark, student: str, options: Iterable[str]) -> None:
        """One student's part."""
        self.points = max(self.points, part.points)
        self.blank += part.status == "blank"
        self.undecided += part.undecided
        if options:
            self.had.update(options)
            self.chosen.update(part.chosen)
        if part.note and part.status in WRONG:
            self.notes[part.note] += 1
            self.examples.setdefault(part.note, Example(student, part.id, part.typed))

    def mistakes(self) -> tuple[Mistake, ...]:
        """The most frequent first."""
        common = sorted(self.notes.items(), key=lambda pair: (-pair[1], pair[0]))
        return tuple(Mistake(note, count, self.examples[note]) for note, count in common)

    def options(self) -> tuple[tuple[str, int, int], ...]:
        """The least chosen first, by share."""
        rows = [(name, had, self.chosen[name]) for name, had in self.had.items()]
        return tuple(sorted(rows, key=lambda row: (row[2] / row[1], row[0])))


def analysed(pairs: Iterable[tuple[Marks, Outline]]) -> Analysis:
    """Analyse a class.

    Parameters
    ----------
    pairs : iterable
        The marks of each student with what the paper asked; gone through once.
    """
    counts: dict[str, _Counts] = defaultdict(_Counts)
    by_item: list[dict[str, float]] = []
    by_question: list[dict[str, float]] = []
    draws, totals, points, minutes = Draws(), [], 0.0, []
    for marks, outline in pairs:
        for part in marks.parts:
            counts[part.item].add(part, marks.student, outline.options.get(part.item, ()))
        by_item.append(_known(marks.parts))
        questions = _questions(marks.parts)
        by_question.append(questions)
        for template, share in _shares(marks.parts, questions).items():
            draws.add(template, outline.identities.get(template, ""), share)
        totals.append(marks.marks)
        points = max(points, marks.points)
        minutes += [marks.minutes] if marks.minutes is not None else []
    table, names = _table(by_item)
    whole, asked = _table(by_question)
    found = alpha(whole)
    return Analysis(
        len(totals),
        tuple(totals),
        points,
        tuple(minutes),
        len(asked),
        found,
        None if found is None else alpha_interval(found, len(totals), len(asked)),
        tuple(_figures(item, counts[item], table, names) for item in counts),
        tuple(draws.effects()),
    )


def _known(parts: Iterable[PartMark]) -> dict[str, float]:
    """Points by item, where they are known and count."""
    return {p.item: p.marks for p in parts if p.marks is not None and p.status != DROPPED}


def _questions(parts: Sequence[PartMark]) -> dict[str, float]:
    """Points by question, where all its parts are decided."""
    found: dict[str, float] = defaultdict(float)
    unknown = {_template(part.item) for part in parts if part.marks is None}
    for part in parts:
        name = _template(part.item)
        if part.marks is not None and part.status != DROPPED and name not in unknown:
            found[name] += part.marks
    return found


def _shares(parts: Iterable[PartMark], questions: Mapping[str, float]) -> dict[str, float]:
    """Share of its points by question, where all its parts are decided."""
    worth: dict[str, float] = defaultdict(float)
    for part in parts:
        worth[_template(part.item)] += part.points
    return {name: got / worth[name] for name, got in questions.items() if worth[name]}


def _template(item: str) -> str:
    return item.partition("/")[0]


def _table(rows: list[dict[str, float]]) -> tuple[Table, list[str]]:
    """Points as a table, and the names of its columns."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    values = [[row.get(name, np.nan) for name in names] for row in rows]
    return np.array(values, float).reshape(len(rows), len(names)), names


def _figures(item: str, counts: _Counts, table: Table, names: list[str]) -> ItemFigures:
    difficulty = discrimination = None
    known = 0
    if item in names:
        column = names.index(item)
        own = table[:, column]
        known = int((~np.isnan(own)).sum())
        difficulty = float(np.nanmean(own)) / counts.points if counts.points else None
        discrimination = rest_correlation(table, column)
    return ItemFigures(
        item,
        known,
        counts.points,
        difficulty,
        discrimination,
        counts.blank,
        counts.undecided,
        counts.mistakes(),
        counts.options(),
    )
