"""Random numbers of the effects, and how far luck carries a value."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import DTypeLike, NDArray

from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import FULL_WELL
from quizgen.camera.setup.view import View
from quizgen.numerics.gaussian import inverse_upper_tail

PixelPlaces = NDArray[np.intp]

WORDS = 1 << 16
TAIL = 256
"""Cells at either end of the table in which values are drawn from the tail itself (|z| > 2.6)."""
FARTHEST = 7.9
"""Standard deviations that no luck exceeds: the last step of the tail has the chance 2^-49."""
_RAREST = 49.0 * math.log(2.0)


class EffectRandom:
    """Random numbers of one effect: each tile has its own, whichever process computes it.

    Philox counts: the seed is the key, the number of the tile the upper part of the counter. One
    thread at a time may draw from it; each run of an effect has its own.

    Parameters
    ----------
    key : int
    """

    def __init__(self, key: int) -> None:
        self._source = np.random.Philox(key=key)
        self._start = self._source.state  # a new source for every tile would take as long again

    def _draw_raw(self, tile: int, count: int, stream: int = 0) -> NDArray[np.uint64]:
        """Return whole numbers below 2^64; the streams of one tile are independent."""
        self._start["state"]["counter"][1:3] = tile, stream
        self._source.state = self._start
        raw: NDArray[np.uint64] = self._source.random_raw(count).astype("<u8", copy=False)
        return raw

    def _draw_words(self, tile: int, count: int) -> NDArray[np.uint16]:
        """Return whole numbers below 2^16, each as likely."""
        return self._draw_raw(tile, -(-count // 4)).view("<u2")[:count]

    def draw_from_table(self, table: Image, tile: int, count: int) -> Image:
        """Return values of a table of 2^16, each as likely."""
        return np.take(table, self._draw_words(tile, count), mode="clip")

    def draw_normal(
        self, tile: int, count: int, kind: DTypeLike = np.float32, *, fine: bool = False
    ) -> Image:
        """Return standard normal values up to `FARTHEST`, the same in every precision but rounded.

        Parameters
        ----------
        tile, count : int
        kind : dtype
        fine : bool
            Draw 8 more bits for every value. Without them those that are no more than 2.6 are
            the middles of 2^16 equal probabilities: enough where they are added to a picture, but
            whole counts are so close to each other that some would never be drawn.
        """
        words = self._draw_words(tile, count)
        values = np.take(_normal_table(np.dtype(kind)), words, mode="clip")
        if fine:
            apart = self._draw_raw(tile, -(-count // 8), 2).view("u1")[:count].astype(kind)
            apart -= 255.0 / 2.0
            apart *= np.take(_cell_widths(np.dtype(kind)), words, mode="clip")
            values += apart
        far = np.flatnonzero(words + np.uint16(TAIL) < 2 * TAIL)  # which wraps around
        if far.size:
            ends = words[far]
            cells = np.minimum(ends, ~ends)  # as far from either end
            chances = cells + self._draw_raw(tile, far.size, 1) * 2.0**-64
            sizes = np.interp(chances.view(np.int64), *_tail_table())
            values[far] = np.where(cells == ends, -sizes, sizes)
        return values

    def draw_uniform(self, tile: int, count: int) -> NDArray[np.float64]:
        """Return values in [0, 1), multiples of 2^-32."""
        return self._draw_words(tile, 2 * count).view("<u4") * 2.0**-32


@cache
def _normal_table(kind: np.dtype[np.floating]) -> Image:
    """Return normal quantiles at the middles of 2^16 equal probabilities, scaled to variance 1."""
    lower = -np.asarray(inverse_upper_tail((np.arange(WORDS // 2) + 0.5) / WORDS))
    lower /= math.sqrt(float(np.mean(lower * lower)))
    return np.concatenate([lower, -lower[::-1]]).astype(kind)


@cache
def _cell_widths(kind: np.dtype[np.floating]) -> Image:
    """Return how far one of 256 steps within its cell moves each value of `_normal_table`.

    Eight more random bits choose the step.
    """
    edges = np.asarray(inverse_upper_tail(np.arange(1, WORDS // 2 + 1) / WORDS))
    lower = np.concatenate([[0.0], -np.diff(edges)]) / 256.0
    return np.concatenate([lower, lower[::-1]]).astype(kind)


@cache
def _tail_table() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return offsets and slopes from the bits of a probability to normal quantiles in the tail.

    The bits of a number, read as a whole one, are straight in each octave: between two of these 256
    an octave a line is off by 1e-6, and no logarithm is needed, whose last bit differs between
    processors.
    """
    cells = np.ldexp(1.0 + np.arange(256) / 256.0, np.arange(-33, 8)[:, None]).reshape(-1)
    return cells.view(np.int64).astype(float), np.asarray(inverse_upper_tail(cells / WORDS))


def effect_random(view: View, effect: str) -> EffectRandom:
    """Return the random numbers of one effect, from the scene's seed and the effect's name.

    Adding, skipping or reordering other effects changes nothing here.
    """
    words = np.frombuffer(effect.encode().ljust(32, b"\0")[:32], "<u4")
    seeds = np.random.SeedSequence([view.scene.seed, *(int(word) for word in words)])
    low, high = seeds.generate_state(2, np.uint64)
    return EffectRandom(int(low) | int(high) << 64)


def electrons_at_white(view: View) -> float:
    """Return the full well in electrons; without one, too many electrons to count."""
    return view.camera[FULL_WELL] or math.inf


def farthest_count(mean: float) -> float:
    """Return a bound in electrons on how far a count is from its mean, for means up to this.

    Chernoff: P(X >= m + t) <= exp(-t^2/(2 (m + t/3))), and no drawn value is rarer
    than 2^-49. One more for whole electrons, and one for the expansion that counts come from.
    """
    third = _RAREST / 3.0
    return third + math.sqrt(third**2 + 2.0 * mean * _RAREST) + 2.0


def add_normal_noise(sigma: float, source: EffectRandom) -> TileOperation:
    """Return what adds normal noise of a standard deviation (1 = white) to a tile."""
    scale = float(sigma)

    def work(part: Image, tile: Tile) -> None:
        """Add the noise of a tile in place."""
        spread = source.draw_normal(tile.number, part.size, part.dtype)
        spread *= scale
        part += spread

    return work


# Poisson counts


Numbers = NDArray[np.floating]

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
    """Return Poisson counts at the probabilities that standard normal values have.

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
        counts[few] = _count_few(mean[few], normal[few])
    return counts


def _count_few(mean: Numbers, normal: Numbers) -> PixelPlaces:
    """Return the counts for small means, from tables: the least one of a cell, or one more."""
    least, below, rates = _count_tables(mean.dtype)
    place = np.sqrt(mean)
    place *= _CELLS
    column = place.astype(np.intp)
    place -= column
    node = ((normal + _LUCK) * _CELLS).astype(np.intp)
    node *= _COLUMNS
    node += column
    node = least[node]
    beyond = _normal_cdf(normal) > _interpolate_cubic(place, node, below, rates)
    return node // _COLUMNS + beyond


def _interpolate_cubic(t: Numbers, node: PixelPlaces, values: Numbers, rates: Numbers) -> Numbers:
    """Return values at share t (0 to 1) between two nodes, by values and slopes at both."""
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
def _count_tables(kind: np.dtype[np.floating]) -> tuple[PixelPlaces, Numbers, Numbers]:
    """Return by cell: node of the least count, probability of at most that count, its slope.

    Rows are normal values, or counts; columns are roots of means; all flattened. Over a cell a
    count grows by one at most. The slope by the mean is minus the chance of the count; the cubic
    is within 1e-6 of the chance.
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


def _normal_cdf(normal: Numbers) -> Numbers:
    """Return the normal distribution function within 1e-7 (Abramowitz and Stegun 26.2.17)."""
    t = 1.0 / (1.0 + 0.2316419 * np.abs(normal))
    series = 0.31938153 + t * (
        -0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429))
    )
    tail = t * series * np.exp(-normal * normal / 2.0) / math.sqrt(2.0 * math.pi)
    return np.where(normal < 0.0, tail, 1.0 - tail)
