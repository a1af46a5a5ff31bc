"""Random numbers of the effects, and what noise does to facts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from itertools import accumulate
from statistics import NormalDist

import numpy as np

from quizgen.camera.body import FULL_WELL
from quizgen.camera.facts import REACH, Error, Facts
from quizgen.camera.scene import Image
from quizgen.camera.view import View

_PART = 1 << 15

POISSON_GAP = 6.4
"""Electrons by which a Poisson count lies farther from its mean than z standard deviations, up to
z = 6 at any mean: (z^2 - 1)/6 for the skewness and 1/2 for whole electrons. So far apart are also
the quantiles of Poisson and normal law up to z = 5: z^2/4 where the normal law turns negative."""

_FEW = 16.0
_NEVER = 9.8e-10
"""Chance of a normal value above z = 6."""


def stream(view: View, effect: str) -> np.random.Generator:
    """Random numbers of one effect: SFC64 from the scene's seed and the effect's name.

    Adding, skipping or reordering other effects changes nothing here.
    """
    words = np.frombuffer(effect.encode().ljust(32, b"\0")[:32], "<u4")
    seeds = np.random.SeedSequence([view.scene.seed, *(int(word) for word in words)])
    return np.random.Generator(np.random.SFC64(seeds))


def bands(shape: tuple[int, ...]) -> Iterator[slice]:
    """Rows in bands that stay in the processor's cache."""
    rows = max(1, _PART // math.prod(shape[1:]))
    for start in range(0, shape[0], rows):
        yield slice(start, start + rows)


def electrons_at_white(view: View) -> float:
    """The full well; without one, electrons are too many to count."""
    return view.camera[FULL_WELL] or math.inf


@lru_cache(maxsize=256)
def poisson_gap(mean: float) -> float:
    """`POISSON_GAP` of means up to this one, from the exact tails where counts are few.

    The count k is reached by the luck z whose normal tail is the chance of k or more.
    """
    if mean >= _FEW:
        return POISSON_GAP
    chances = list(accumulate(range(1, 80), lambda p, k: p * mean / k, initial=math.exp(-mean)))
    gap, beyond = 1.0, 0.0
    for count in range(len(chances) - 1, 0, -1):
        beyond += chances[count]
        if _NEVER < beyond < 0.5:
            luck = -NormalDist().inv_cdf(beyond)
            gap = max(gap, count - mean - math.sqrt(mean) * luck)
    return gap


def noisier(facts: Facts, more: Error) -> Facts:
    """Facts with more of the random part."""
    noise, far = math.hypot(facts.noise, more.sigma), more.sure + REACH * more.sigma
    limits = facts.limits[0] - far, facts.limits[1] + far
    return replace(facts, noise=noise, tail=facts.tail + more.sure, limits=limits)


def add_normal(image: Image, sigma: float, source: np.random.Generator) -> Image:
    """Add normal noise, band by band."""
    result = np.empty_like(image)
    for rows in bands(image.shape):
        spread = source.standard_normal(image[rows].shape, np.float32)
        spread *= np.float32(sigma)
        np.add(image[rows], spread, out=result[rows])
    return result
