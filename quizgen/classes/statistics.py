"""What is known of a test from its points: reliability, discrimination, differences.

Quantiles and probabilities come from FLINT's incomplete beta and gamma functions. A value that the
points do not determine (one item, one student, no spread) is None.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import StatisticsError, correlation

import numpy as np
from flint import arb
from numpy.typing import NDArray

from quizgen.maths.precision import working_precision

ScoreTable = NDArray[np.float64]
"""A row for each student, a column for each item; NaN where there are no points."""

HALVINGS = 34
"""Of the interval in which a quantile lies: ten digits."""
BITS = 64
"""Working precision of probabilities, which nobody asks to more than a few digits."""


def covariance(scores: ScoreTable) -> ScoreTable:
    """Return the covariance matrix of the columns, each over students who have both (pairwise)."""
    known = ~np.isnan(scores)
    filled = np.where(known, scores, 0.0)
    there = known.astype(float)
    both = there.T @ there
    with np.errstate(invalid="ignore", divide="ignore"):
        products = filled.T @ filled - (filled.T @ there) * (there.T @ filled) / both
        return np.where(both > 1, products / (both - 1), np.nan)


def cronbach_alpha(scores: ScoreTable) -> float | None:
    """Return Cronbach's alpha; None with fewer than two items or students, or no spread."""
    items = scores.shape[1]
    if items < 2 or scores.shape[0] < 2:
        return None
    found = covariance(scores)
    total = float(found.sum())
    if not math.isfinite(total) or total <= 0:
        return None
    return items / (items - 1) * (1 - float(np.trace(found)) / total)


def feldt_interval(
    value: float, students: int, items: int, confidence: float = 0.95
) -> tuple[float, float]:
    """Return lower and upper end of Feldt's confidence interval of Cronbach's alpha.

    Parameters
    ----------
    value : float
        The alpha that was found.
    students, items : int
        From how many.
    confidence : float
    """
    first, second = students - 1, (students - 1) * (items - 1)
    tail = (1 - confidence) / 2
    ends = (f_distribution_quantile(share, first, second) for share in (1 - tail, tail))
    lower, upper = (1 - (1 - value) * end for end in ends)
    return lower, upper


def item_rest_correlation(scores: ScoreTable, column: int) -> float | None:
    """Return the correlation of an item with the sum of all others; None if undetermined.

    The corrected item-total correlation: an item must not correlate with itself.
    """
    rest = np.nansum(np.delete(scores, column, axis=1), axis=1)
    return pearson(scores[:, column], rest)


def pearson(first: ScoreTable, second: ScoreTable) -> float | None:
    """Return Pearson's correlation over the students who have both; None without spread."""
    both = ~(np.isnan(first) | np.isnan(second))
    try:
        return correlation(first[both].tolist(), second[both].tolist())
    except StatisticsError:  # fewer than two, or all the same
        return None


def average_ranks(values: ScoreTable) -> ScoreTable:
    """Return the ranks from 1; equal values share the mean of theirs."""
    _, place, counts = np.unique(values, return_inverse=True, return_counts=True)
    last = np.cumsum(counts)
    return (last - (counts - 1) / 2)[place]


def kruskal_wallis(groups: Sequence[ScoreTable]) -> float | None:
    """Return the p-value of the Kruskal-Wallis test; None if all values are equal."""
    values = np.concatenate(groups)
    count = len(values)
    placed = average_ranks(values)
    _, ties = np.unique(values, return_counts=True)
    unequal = 1 - float((ties.astype(float) ** 3 - ties).sum()) / (count**3 - count)
    if unequal <= 0:
        return None
    pieces = np.split(placed, np.cumsum([len(group) for group in groups])[:-1])
    between = sum(float(piece.sum()) ** 2 / len(piece) for piece in pieces)
    found = (12 / (count * (count + 1)) * between - 3 * (count + 1)) / unequal
    return chi_square_tail(max(found, 0.0), len(groups) - 1)


def spearman(first: ScoreTable, second: ScoreTable) -> tuple[float, float] | None:
    """Return Spearman's rank correlation and its p-value; None if undetermined."""
    found = pearson(average_ranks(first), average_ranks(second))
    free = len(first) - 2
    if found is None or free < 1:
        return None
    left = max(1 - found**2, 1e-15)
    return found, f_tail(found**2 * free / left, 1, free)


def holm_correction(chances: Sequence[float]) -> list[float]:
    """Return the p-values after Holm's correction for several tests, in the same order."""
    order = sorted(range(len(chances)), key=chances.__getitem__)
    adjusted, least = [0.0] * len(chances), 0.0
    for place, index in enumerate(order):
        least = max(least, min(1.0, (len(chances) - place) * chances[index]))
        adjusted[index] = least
    return adjusted


@working_precision(BITS)
def chi_square_tail(value: float, free: int) -> float:
    """Return the probability of more than ``value``, with ``free`` degrees of freedom."""
    return float(arb(value / 2).gamma_upper(arb(free) / 2, regularized=1).mid())


@working_precision(BITS)
def f_tail(value: float, first: int, second: int) -> float:
    """Return the probability of more than ``value`` under the F distribution.

    ``first`` and ``second`` are the degrees of freedom of numerator and denominator.
    """
    share = arb(second) / (second + first * arb(value))
    return float(share.beta_lower(arb(second) / 2, arb(first) / 2, regularized=1).mid())


def f_distribution_quantile(share: float, first: int, second: int) -> float:
    """Return the quantile of the F distribution at ``share`` (0 to 1)."""
    low, high = 0.0, 1.0
    while f_tail(high, first, second) > 1 - share:
        low, high = high, 2 * high
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if f_tail(middle, first, second) > 1 - share:
            low = middle
        else:
            high = middle
    return high
