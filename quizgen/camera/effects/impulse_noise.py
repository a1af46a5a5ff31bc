"""Impulse noise: salt and pepper on the finished picture."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, on_picture
from quizgen.camera.facts import Error, Facts
from quizgen.camera.noise import stream
from quizgen.camera.scene import Image
from quizgen.camera.settings import SHARE, Setting
from quizgen.camera.values import quantity
from quizgen.camera.view import View

IMPULSE_NOISE = Setting("impulse_noise", quantity("%"), 0.0, (SHARE,))
"""Share of pixels turned black or white (half each)."""


def add_impulses(image: Image, share: float, source: np.random.Generator) -> Image:
    """Salt and pepper: each pixel turns black or white with probability share/2 each.

    Parameters
    ----------
    image : numpy.ndarray
        Shape (H, W, C); all channels of a pixel are hit together (errata EC6).
    share : float
        In [0, 1]; more would let salt overwrite pepper.
    source : numpy.random.Generator
    """
    if not 0.0 <= share <= 1.0:
        raise ValueError("the share of impulses lies in [0, 1]")
    draw = source.random(image.shape[:2])[..., None]
    pepper = np.where(draw < share / 2, np.float32(0.0), image)
    return np.where(draw >= 1.0 - share / 2, np.float32(1.0), pepper)


def run(image: Image, view: View, rung: str = "") -> Image:
    """`add_impulses` with the camera's share."""
    return add_impulses(image, view.camera[IMPULSE_NOISE], stream(view, "impulse noise"))


def skipped(facts: Facts, view: View) -> Error:
    """Any pixel may turn black or white."""
    return Error(math.inf)


def after(facts: Facts, view: View) -> Facts:
    """Steps of the whole range."""
    low, high = facts.limits
    wide = replace(facts, low=min(facts.low, 0.0), high=max(facts.high, 1.0))
    wide = replace(wide, limits=(min(low, 0.0), max(high, 1.0)))
    return wide.with_jump((wide.span, wide.span))


EFFECT = Effect(
    name="impulse noise",
    stage="edit",
    decides=("impulse noise", "noise", "snr", "histogram"),
    settings=(IMPULSE_NOISE,),
    present=lambda view: view.camera[IMPULSE_NOISE] > 0.0,
    run=on_picture(run),
    cost=measured((4.13, 200)),
    skipped=skipped,
    after=after,
    random=True,
)
