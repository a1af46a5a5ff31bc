"""Gaussian noise on the finished picture."""

from __future__ import annotations

import numpy as np

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.effects.effect import (
    Effect,
    PointByPoint,
    Size,
)
from quizgen.camera.noise import FARTHEST, Luck, luck, normal_noise
from quizgen.camera.scene import Image
from quizgen.camera.setup.settings import NOT_NEGATIVE, Setting
from quizgen.camera.setup.values import number
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


def work(view: View) -> Work:
    """Add the camera's normal noise, then clip."""
    return gaussian(view.camera[GAUSSIAN_NOISE], luck(view, "gaussian noise"))


def _far(view: View) -> float:
    return FARTHEST * view.camera[GAUSSIAN_NOISE]


EFFECT = Effect(
    name="gaussian noise",
    stage="edit",
    answers=("gaussian noise", "noise", "snr", "histogram"),
    settings=(GAUSSIAN_NOISE,),
    is_present=lambda view: view.camera[GAUSSIAN_NOISE] > 0.0,
    run=PointByPoint(work),
    omission_bound=lambda signal, view: signal.outside(0.0, 1.0) + _far(view),
    range_after=lambda signal, view: signal.widened(_far(view), _far(view)).clipped(0.0, 1.0),
    size=Size(
        lambda view: 255.0 * view.camera[GAUSSIAN_NOISE], "add noise of {:.3g} grey levels", 2.0
    ),
    speckles=True,
)
