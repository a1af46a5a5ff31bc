"""Digits along the way to a formula's difficulty, and those of its exam inputs."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from quizgen.tradeoff.formulas import Columns, Formula
from quizgen.tradeoff.lines import Column
from quizgen.tradeoff.truth import correct_digits, truths

EXAMS, PLACES = 200, 43
"""Inputs drawn as in an exam, and places along a path."""
SEED = 20240404


@dataclass(frozen=True)
class Way:
    """One way of computing along a path: its results, and how many of their digits are right."""

    values: tuple[float, ...]
    digits: tuple[float, ...]


@dataclass(frozen=True)
class FormulaSweep:
    """Results of one formula along its path from easy to hard.

    Parameters
    ----------
    name : str
    left : tuple of float
        Distances to the difficulty.
    moved : tuple of float
        Values of what the slider moves; none without a slider.
    right : tuple of float
        Correctly rounded results.
    ways : dict of str to Way
        ``float64`` and ``float32`` as printed, and ``stable`` where there is such a form.
    exam_left, exam_digits : float
        Of inputs as in an exam, printed formula in float64: least distance, digits of the worst.
    """

    name: str
    left: tuple[float, ...]
    moved: tuple[float, ...]
    right: tuple[float, ...]
    ways: dict[str, Way]
    exam_left: float
    exam_digits: float


def sweep_formula(formula: Formula) -> FormulaSweep:
    """Return a formula's results along its path, and how it does on exam inputs."""
    rng = np.random.default_rng(SEED)
    exam = [np.asarray(column, np.float64) for column in formula.exam(rng, EXAMS)]
    path = [np.asarray(column, np.float64) for column in formula.path(formula.places(PLACES))]
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        right = truths(formula, path)
        ways = {
            name: Way(tuple(map(float, found)), _count_digits_per_point(formula, found, right))
            for name, found in _compute_by_system(formula, path).items()
        }
        worst = min(_count_digits_per_point(formula, formula.compute(exam), truths(formula, exam)))
        away = np.abs(formula.left(*exam))
        moved = () if formula.shown is None else formula.shown.value(*path)
        left = formula.left(*path)
    return FormulaSweep(
        formula.name, tuple(map(float, left)), tuple(map(float, moved)), tuple(right.tolist()),
        ways, float(away[away > 0].min()), worst,
    )  # fmt: skip


def _compute_by_system(formula: Formula, columns: Columns) -> dict[str, Column]:
    """Return the results as printed in float64 and float32, and those of the stable form."""
    found = {"float64": formula.compute(columns), "float32": formula.compute(columns, 32)}
    if formula.stable is not None:
        found["stable"] = np.ma.filled(formula.stable(*columns), np.nan)
    return found


def _count_digits_per_point(formula: Formula, found: Column, right: Column) -> tuple[float, ...]:
    """Return the number of right digits of each result."""
    pairs = zip(found.tolist(), right.tolist(), strict=True)
    return tuple(correct_digits(value, truth, formula.turn) for value, truth in pairs)
