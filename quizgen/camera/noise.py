"""Random numbers of the effects, and what noise does to facts."""

from __future__ import annotations

import math
from functools import cache, lru_cache
from itertools import accumulate

import numpy as np
from msgspec.structs import replace
from numpy.typing import DTypeLike, NDArray

from quizgen.arrays.gaussian import inverse_tail
from quizgen.camera.blocks import Tile, Work
from quizgen.camera.body import FULL_WELL
from quizgen.camera.facts import REACH, Error, Facts
from quizgen.camera.scene import Image
from quizgen.camera.view import View

POISSON_GAP = 6.4
"""Electrons by which the quantiles of Poisson and normal law are apart up to z = 5 deviations, at
any mean: z^2/4 where the normal law turns negative."""

_FARTHER = 4.6
"""Electrons by which a Poisson count lies farther from its mean than z standard deviations, up to
z = 5 at any mean: (z^2 - 1)/6 for the skewness and 1/2 for whole electrons. No luck is larger."""

MANY = 16.0
"""Electrons from which on counts keep to the root of their own mean, and those of all below."""
Places = NDArray[np.intp]

_NEVER = 2.8e-7
"""Chance of a normal value above z = 5."""


class Luck:
    """Random numbers of one effect: every tile of a picture has its own, whoever works on it.

    Philox counts: the seed is the key, the number of the tile the upper part of the counter. One
    thread at a time may draw from it; each run of an effect has its own.

    Parameters
    ----------
    key : int
    """

    def __init__(self, key: int) -> None:
        self._source = np.random.Philox(key=key)
        self._start = self._source.state  # a new source for every tile would take as long again

    def _words(self, tile: int, count: int) -> NDArray[np.uint16]:
        """Whole numbers below 2^16, each as likely."""
        self._start["state"]["counter"][1] = tile
        self._source.state = self._start
        raw: NDArray[np.uint64] = self._source.random_raw(-(-count // 4)).astype("<u8", copy=False)
        return raw.view("<u2")[:count]

    def pick(self, table: Image, tile: int, count: int) -> Image:
        """Values of a table of 2^16, each as likely."""
        return np.take(table, self._words(tile, count), mode="clip")

    def beyond(self, first: int, tile: int, count: int) -> tuple[Places, NDArray[np.uint16]]:
        """Where a table of 2^16 is read from a place on, and at which places."""
        words = self._words(tile, count)
        where = np.flatnonzero(words >= first)
        return where, words[where]

    def normal(self, tile: int, count: int, kind: DTypeLike = np.float32) -> Image:
        """Standard normal values; their distribution function is within 8e-6 of the normal one.

        The same luck in every precision, rounded to it.
        """
        return self.pick(_normals(np.dtype(kind)), tile, count)

    def uniform(self, tile: int, count: int) -> NDArray[np.float64]:
        """Values in [0, 1), multiples of 2^-32."""
        return self._words(tile, 2 * count).view("<u4") * 2.0**-32


WORDS = 1 << 16


@cache
def _normals(kind: np.dtype[np.floating]) -> Image:
    """Normal quantiles in the middle of 2^16 equal probabilities, scaled to variance 1."""
    lower = -np.asarray(inverse_tail((np.arange(WORDS // 2) + 0.5) / WORDS))
    lower /= math.sqrt(float(np.mean(lower * lower)))
    return np.concatenate([lower, -lower[::-1]]).astype(kind)


def luck(view: View, effect: str) -> Luck:
    """Random numbers of one effect, from the scene's seed and the effect's name.

    Adding, skipping or reordering other effects changes nothing here.
    """
    words = np.frombuffer(effect.encode().ljust(32, b"\0")[:32], "<u4")
    seeds = np.random.SeedSequence([view.scene.seed, *(int(word) for word in words)])
    low, high = seeds.generate_state(2, np.uint64)
    return Luck(int(low) | int(high) << 64)


def electrons_at_white(view: View) -> float:
    """The full well; without one, electrons are too many to count."""
    return view.camera[FULL_WELL] or math.inf


@lru_cache(maxsize=256)
def poisson_gap(mean: float) -> float:
    """`_FARTHER` for means up to this one, from the exact tails where counts are few.

    The count k is reached by the luck z whose normal tail is the chance of k or more.
    """
    if mean >= MANY:
        return _FARTHER
    chances = list(accumulate(range(1, 80), lambda p, k: p * mean / k, initial=math.exp(-mean)))
    gap, beyond = 1.0, 0.0
    for count in range(len(chances) - 1, 0, -1):
        beyond += chances[count]
        if _NEVER < beyond < 0.5:
            luck = float(inverse_tail(beyond))
            gap = max(gap, count - mean - math.sqrt(mean) * luck)
    return gap


def noisier(facts: Facts, more: Error, dip: tuple[float, float] | None = None) -> Facts:
    """Facts with more of the random part; where that is known, with less of it below."""
    noise, far = math.hypot(facts.noise, more.sigma), more.sure + REACH * more.sigma
    limits = facts.limits[0] - far, facts.limits[1] + far
    if dip is None and facts.dip is not None:
        dip = more.sure, more.sigma
    if dip is not None:
        tail, deviation = facts.down
        dip = tail + dip[0], math.hypot(deviation, dip[1])
    return replace(facts, noise=noise, tail=facts.tail + more.sure, limits=limits, dip=dip)


def normal_noise(sigma: float, source: Luck) -> Work:
    """Add normal noise."""
    scale = float(sigma)

    def work(part: Image, tile: Tile) -> None:
        spread = source.normal(tile.number, part.size, part.dtype)
        spread *= scale
        part += spread

    return work
