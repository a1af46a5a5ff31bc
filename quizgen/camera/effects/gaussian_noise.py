"""Gaussian noise on the finished picture."""

from __future__ import annotations

import math

import numpy as np
from msgspec.structs import replace

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.facts import Error, Facts
from quizgen.camera.noise import Luck, luck, normal_noise
from quizgen.camera.scene import Image
from quizgen.camera.settings import NOT_NEGATIVE, Setting
from quizgen.camera.values import number
from quizgen.camera.view import View

GAUSSIAN_NOISE = Setting("gaussian_noise", number, 0.0, (NOT_NEGATIVE,))
"""Standard deviation, 1 = white."""


def gaussian(sigma: float, source: Luck) -> Work:
    """Normal noise on a picture in [0, 1], clipped to it.

    Black gains 0.399 sigma on average (errata E39).

    Parameters
    ----------
    sigma : float
        Standard deviation, 1 = white.
    source : Luck
        Passed in, never shared between effects (errata EC5).
    """
    add = normal_noise(sigma, source)

    def work(part: Image, tile: Tile) -> None:
        add(part, tile)
        np.clip(part, 0.0, 1.0, out=part)

    return work


def work(view: View, rung: str = "") -> Work:
    """Add the camera's normal noise, then clip."""
    return gaussian(view.camera[GAUSSIAN_NOISE], luck(view, "gaussian noise"))


def skipped(facts: Facts, view: View) -> Error:
    """Its standard deviation, and what it clips."""
    return facts.outside(0.0, 1.0).plus(Error(sigma=view.camera[GAUSSIAN_NOISE]))


def after(facts: Facts, view: View) -> Facts:
    """Noisier and clipped."""
    low, high = min(max(facts.low, 0.0), 1.0), max(0.0, min(facts.high, 1.0))
    noise = math.hypot(facts.noise, view.camera[GAUSSIAN_NOISE])
    noisy = replace(facts, noise=noise, low=low, high=high, limits=(0.0, 1.0), dip=None)
    return noisy.with_jump(facts.jump)


EFFECT = Effect(
    name="gaussian noise",
    stage="edit",
    decides=("gaussian noise", "noise", "snr", "histogram"),
    settings=(GAUSSIAN_NOISE,),
    present=lambda view: view.camera[GAUSSIAN_NOISE] > 0.0,
    run=PointByPoint(work),
    cost=measured((2.97, 130)),
    skipped=skipped,
    after=after,
    random=True,
)
