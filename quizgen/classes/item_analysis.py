"""What the marks of a class say about its questions."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np

from quizgen.classes.grading import DROPPED, GradedClassPart, StudentMarks, question_number
from quizgen.classes.key_index import PaperOutline
from quizgen.classes.statistics import (
    ScoreTable,
    cronbach_alpha,
    feldt_interval,
    item_rest_correlation,
)
from quizgen.classes.variant_difficulty import VariantDifficulty, VariantEffect

WRONG = frozenset({"wrong", "partial"})


@dataclass(frozen=True)
class MistakeExample:
    """An answer that shows a mistake, and whose it is."""

    student: str
    part: str
    typed: str


@dataclass(frozen=True)
class ClassMistake:
    """A misconception by its note, how many students showed it, and an example."""

    note: str
    students: int
    example: MistakeExample


@dataclass(frozen=True)
class ItemStatistics:
    """Classical test statistics of one item over the class.

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
    mistakes : tuple of ClassMistake
        The most frequent first.
    options : tuple of (str, int, int)
        Option, how many had it, how many chose it; the least chosen first.
    numbers : tuple of str
        Under which it is printed: one, where all papers have the same order.
    seconds : tuple of float
        For which a browser showed the whole question to those who sat it there.
    """

    item: str
    students: int
    points: float
    difficulty: float | None
    discrimination: float | None
    blank: int
    undecided: int
    mistakes: tuple[ClassMistake, ...]
    options: tuple[tuple[str, int, int], ...]
    numbers: tuple[str, ...] = ()
    seconds: tuple[float, ...] = ()

    @property
    def minutes(self) -> float | None:
        """Return the median time of the whole question in minutes; None if none is known."""
        return median(self.seconds) / 60 if self.seconds else None

    @property
    def number(self) -> str:
        """Return what the item is called on paper, such as ``7b``."""
        return " / ".join(self.numbers)

    @property
    def never(self) -> list[str]:
        """Return the options that nobody chose."""
        return [name for name, had, chosen in self.options if had and not chosen]


@dataclass(frozen=True)
class ClassAnalysis:
    """Statistics of a class: totals, reliability, items, and effects of drawn values.

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
    items : tuple of ItemStatistics
    effects : tuple of VariantEffect
    """

    students: int
    totals: tuple[float, ...]
    points: float
    minutes: tuple[float, ...]
    questions: int
    alpha: float | None
    interval: tuple[float, float] | None
    items: tuple[ItemStatistics, ...]
    effects: tuple[VariantEffect, ...]


class _Counts:
    """What is counted of one item, student by student."""

    def __init__(self) -> None:
        self.points = 0.0
        self.blank = self.undecided = 0
        self.notes: Counter[str] = Counter()
        self.examples: dict[str, MistakeExample] = {}
        self.had: Counter[str] = Counter()
        self.chosen: Counter[str] = Counter()
        self.numbers: dict[str, None] = {}
        self.seconds: list[float] = []

    def add(self, part: GradedClassPart, marks: StudentMarks, options: Iterable[str]) -> None:
        """Count one student's part; ``options`` are those its paper showed."""
        time = marks.seconds.get(question_number(part.id, part.item))
        self.seconds += [] if time is None else [time]
        self.points = max(self.points, part.points)
        self.numbers[part.id] = None
        self.blank += part.status == "blank"
        self.undecided += part.needs_decision
        if options:
            self.had.update(options)
            self.chosen.update(part.chosen)
        if part.note and part.status in WRONG:
            self.notes[part.note] += 1
            self.examples.setdefault(part.note, MistakeExample(marks.student, part.id, part.typed))

    def mistakes(self) -> tuple[ClassMistake, ...]:
        """Return the mistakes, the most frequent first."""
        common = sorted(self.notes.items(), key=lambda pair: (-pair[1], pair[0]))
        return tuple(ClassMistake(note, count, self.examples[note]) for note, count in common)

    def options(self) -> tuple[tuple[str, int, int], ...]:
        """Return option, times shown and times chosen; the least chosen share first."""
        rows = [(name, had, self.chosen[name]) for name, had in self.had.items()]
        return tuple(sorted(rows, key=lambda row: (row[2] / row[1], row[0])))


def analyse_class(pairs: Iterable[tuple[StudentMarks, PaperOutline]]) -> ClassAnalysis:
    """Return the item analysis of a class.

    Parameters
    ----------
    pairs : iterable
        The marks of each student with what the paper asked; gone through once.
    """
    counts: dict[str, _Counts] = defaultdict(_Counts)
    by_item: list[dict[str, float]] = []
    by_question: list[dict[str, float]] = []
    draws, totals, points, minutes = VariantDifficulty(), [], 0.0, []
    for marks, outline in pairs:
        for part in marks.parts:
            counts[part.item].add(part, marks, outline.options.get(part.item, ()))
        by_item.append(_index_points_by_item(marks.parts))
        questions = _sum_points_by_question(marks.parts)
        by_question.append(questions)
        for template, share in _compute_question_shares(marks.parts, questions).items():
            draws.add(template, outline.identities.get(template, ""), share)
        totals.append(marks.marks)
        points = max(points, marks.points)
        minutes += [marks.minutes] if marks.minutes is not None else []
    table, names = _build_points_table(by_item)
    whole, asked = _build_points_table(by_question)
    found = cronbach_alpha(whole)
    return ClassAnalysis(
        len(totals),
        tuple(totals),
        points,
        tuple(minutes),
        len(asked),
        found,
        None if found is None else feldt_interval(found, len(totals), len(asked)),
        tuple(_compute_item_figures(item, counts[item], table, names) for item in counts),
        tuple(draws.find_effects()),
    )


def _index_points_by_item(parts: Iterable[GradedClassPart]) -> dict[str, float]:
    """Return the points of each item that is decided and counts."""
    return {p.item: p.marks for p in parts if p.marks is not None and p.status != DROPPED}


def _sum_points_by_question(parts: Sequence[GradedClassPart]) -> dict[str, float]:
    """Return the points of each question whose parts are all decided."""
    found: dict[str, float] = defaultdict(float)
    unknown = {_get_template_name(part.item) for part in parts if part.marks is None}
    for part in parts:
        name = _get_template_name(part.item)
        if part.marks is not None and part.status != DROPPED and name not in unknown:
            found[name] += part.marks
    return found


def _compute_question_shares(
    parts: Iterable[GradedClassPart], questions: Mapping[str, float]
) -> dict[str, float]:
    """Return the share of its points (0 to 1) for each question in ``questions``."""
    worth: dict[str, float] = defaultdict(float)
    for part in parts:
        worth[_get_template_name(part.item)] += part.points
    return {name: got / worth[name] for name, got in questions.items() if worth[name]}


def _get_template_name(item: str) -> str:
    """Return the template of an item name such as ``a-question/b``."""
    return item.partition("/")[0]


def _build_points_table(rows: list[dict[str, float]]) -> tuple[ScoreTable, list[str]]:
    """Return the points, a row per student and NaN where none, and the column names."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    values = [[row.get(name, np.nan) for name in names] for row in rows]
    return np.array(values, float).reshape(len(rows), len(names)), names


def _compute_item_figures(
    item: str, counts: _Counts, table: ScoreTable, names: list[str]
) -> ItemStatistics:
    """Return the statistics of one item from its counts and the points of all items."""
    difficulty = discrimination = None
    known = 0
    if item in names:
        column = names.index(item)
        own = table[:, column]
        known = int((~np.isnan(own)).sum())
        difficulty = float(np.nanmean(own)) / counts.points if counts.points else None
        discrimination = item_rest_correlation(table, column)
    return ItemStatistics(
        item,
        known,
        counts.points,
        difficulty,
        discrimination,
        counts.blank,
        counts.undecided,
        counts.mistakes(),
        counts.options(),
        tuple(counts.numbers),
        tuple(counts.seconds),
    )
