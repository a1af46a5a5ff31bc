"""Poisson counts of given means at given luck.

In: means and standard normal values, pixel by pixel. Out: whole numbers. One normal value per pixel
makes the counts grow with the mean, so that a rounding error in one pixel cannot change its
neighbours.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.floating]
Places = NDArray[np.intp]

FEW_ELECTRONS = 16.18
"""Below this mean, counts are compared with their distribution function."""

_LUCK = 8
"""Normal values of which the tables know, on either side: no luck is larger."""
_CELLS = 20
"""Cells of the tables per standard deviation, and per electron of the mean's root."""
_COLUMNS = math.ceil(math.sqrt(FEW_ELECTRONS) * _CELLS) + 1
_MOST = 128
"""More electrons than any luck makes of few."""


def poisson_quantiles(mean: Numbers, normal: Numbers) -> Numbers:
    """Poisson counts at the probabilities of standard normal values.

    Parameters
    ----------
    mean, normal : numpy.ndarray
        Same shape (N,), same precision; mean >= 0, normal values from -8 to 8.

    Returns
    -------
    numpy.ndarray
        Whole numbers. The distribution function is within 2e-5 of Poisson's: the expansion of its
        inverse in 1/sqrt(mean) (M. Giles, Algorithm 955), exact counting below `FEW_ELECTRONS`.
        Beyond 4.5 deviations they are right within one electron, within a few below a mean of 0.01.
    """
    enough = np.full_like(mean, FEW_ELECTRONS)
    np.maximum(mean, enough, out=enough)  # three times as fast as beside a single number
    root, square = np.sqrt(enough), normal * normal
    inverse = 1.0 / root
    counts = square / 270.0  # the last term, then the one before
    counts += 7.0 / 810.0
    counts *= square
    counts -= 8.0 / 405.0
    counts *= inverse
    counts += normal * (square * (-1.0 / 72.0) - 1.0 / 36.0)
    counts *= inverse
    counts += square * (1.0 / 6.0) + 1.0 / 3.0
    root *= normal
    counts += root
    counts += enough
    np.floor(counts, out=counts)
    np.maximum(counts, 0.0, out=counts)  # the expansion knows no end
    few = np.flatnonzero(mean < FEW_ELECTRONS)
    if few.size:
        counts[few] = _few(mean[few], normal[few])
    return counts


def _few(mean: Numbers, normal: Numbers) -> Places:
    """A count that the luck reaches at least, and one more where it is beyond that one's chance."""
    least, below, rates = _tables(mean.dtype)
    place = np.sqrt(mean)
    place *= _CELLS
    column = place.astype(np.intp)
    place -= column
    node = ((normal + _LUCK) * _CELLS).astype(np.intp)
    node *= _COLUMNS
    node += column
    node = least[node]
    beyond = _normal_below(normal) > _between(place, node, below, rates)
    return node // _COLUMNS + beyond


def _between(t: Numbers, node: Places, values: Numbers, rates: Numbers) -> Numbers:
    """Cubic from one node to the next, by values and slopes at both."""
    first, bend = values[node], rates[node]
    node += 1
    rise = values[node] - first
    bend -= rise
    other = rise - rates[node]
    node -= 1
    rest = 1.0 - t
    bend *= rest
    bend += other * t
    bend *= rest
    bend += rise
    bend *= t
    bend += first
    return bend


@cache
def _tables(kind: np.dtype[np.floating]) -> tuple[Places, Numbers, Numbers]:
    """Node of the least count of each cell; chance of no more than a count, and its slope.

    Rows are luck, or counts; columns are roots of means; all flattened. Over a cell a count grows
    by one at most. The slope by the mean is minus the chance of the count; the cubic is within
    1e-6 of the chance.
    """
    roots = np.arange(_COLUMNS) / _CELLS
    chances = np.empty((_MOST, _COLUMNS))
    chances[0] = np.exp(-roots * roots)
    for count in range(1, _MOST):
        chances[count] = chances[count - 1] * roots * roots / count
    below, rates = np.cumsum(chances, axis=0), chances * roots * (-2.0 / _CELLS)
    edges = np.arange(2 * _LUCK * _CELLS) / _CELLS - _LUCK
    reached = [math.erfc(-edge / math.sqrt(2.0)) / 2.0 for edge in edges]
    least = np.stack([np.searchsorted(column, reached) for column in below.T], axis=1)
    nodes = least * _COLUMNS + np.arange(_COLUMNS)
    return nodes.reshape(-1), below.reshape(-1).astype(kind), rates.reshape(-1).astype(kind)


def _normal_below(normal: Numbers) -> Numbers:
    """Normal distribution function within 1e-7 (Abramowitz and Stegun 26.2.17)."""
    t = 1.0 / (1.0 + 0.2316419 * np.abs(normal))
    series = 0.31938153 + t * (
        -0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429))
    )
    tail = t * series * np.exp(-normal * normal / 2.0) / math.sqrt(2.0 * math.pi)
    return np.where(normal < 0.0, tail, 1.0 - tail)
