"""Random numbers of the effects, and what noise does to facts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from quizgen.camera.body import FULL_WELL
from quizgen.camera.facts import Facts
from quizgen.camera.scene import Image
from quizgen.camera.view import View

_PART = 1 << 15

POISSON_GAP = 3.8
"""Electrons between the quantiles of Poisson and normal law, at any mean, for all but the share
`EXCEEDED` of the values: z^2/4 where the normal law turns negative, else (z^2 - 1)/6 for the
skewness and 1/2 for whole electrons."""


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


def noisier(facts: Facts, sigma: float) -> Facts:
    """Facts with more of the random part."""
    return replace(facts, noise=math.hypot(facts.noise, sigma))


def add_normal(image: Image, sigma: float, source: np.random.Generator) -> Image:
    """Add normal noise, band by band."""
    result = np.empty_like(image)
    for rows in bands(image.shape):
        spread = source.standard_normal(image[rows].shape, np.float32)
        spread *= np.float32(sigma)
        np.add(image[rows], spread, out=result[rows])
    return result
