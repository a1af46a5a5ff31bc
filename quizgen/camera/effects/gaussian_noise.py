"""Gaussian noise on the finished picture."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, on_picture
from quizgen.camera.facts import Error, Facts
from quizgen.camera.noise import stream
from quizgen.camera.scene import Image
from quizgen.camera.settings import NOT_NEGATIVE, Setting
from quizgen.camera.values import number
from quizgen.camera.view import View

GAUSSIAN_NOISE = Setting("gaussian_noise", number, 0.0, (NOT_NEGATIVE,))
"""Standard deviation, 1 = white."""


def add_gaussian(image: Image, sigma: float, source: np.random.Generator) -> Image:
    """Add normal noise, then clip to [0, 1] (black gains 0.399 sigma on average, errata E39).

    Parameters
    ----------
    image : numpy.ndarray
        In [0, 1], float32.
    sigma : float
        Standard deviation, 1 = white.
    source : numpy.random.Generator
        Passed in, never shared between calls (errata EC5).
    """
    noise = source.standard_normal(image.shape, np.float32)
    noise *= np.float32(sigma)
    noise += image
    return np.clip(noise, np.float32(0.0), np.float32(1.0), out=noise)


def run(image: Image, view: View, rung: str = "") -> Image:
    """`add_gaussian` with the camera's sigma."""
    return add_gaussian(image, view.camera[GAUSSIAN_NOISE], stream(view, "gaussian noise"))


def skipped(facts: Facts, view: View) -> Error:
    """Its standard deviation, and what it clips."""
    return facts.outside(0.0, 1.0).plus(Error(sigma=view.camera[GAUSSIAN_NOISE]))


def after(facts: Facts, view: View) -> Facts:
    """Noisier and clipped."""
    low, high = min(max(facts.low, 0.0), 1.0), max(0.0, min(facts.high, 1.0))
    noise = math.hypot(facts.noise, view.camera[GAUSSIAN_NOISE])
    noisy = replace(facts, noise=noise, low=low, high=high, limits=(0.0, 1.0))
    return noisy.with_jump(facts.jump)


EFFECT = Effect(
    name="gaussian noise",
    stage="edit",
    decides=("gaussian noise", "noise", "snr", "histogram"),
    settings=(GAUSSIAN_NOISE,),
    present=lambda view: view.camera[GAUSSIAN_NOISE] > 0.0,
    run=on_picture(run),
    cost=measured((7.18, 302)),
    skipped=skipped,
    after=after,
    random=True,
)
