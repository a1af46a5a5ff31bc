"""Gaussian noise on the finished picture."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, PointByPoint
from quizgen.camera.pixels.noise import FARTHEST, EffectRandom, add_normal_noise, effect_random
from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import NOT_NEGATIVE, Setting
from quizgen.camera.setup.value_parsers import parse_plain_number
from quizgen.camera.setup.view import View

GAUSSIAN_NOISE = Setting("gaussian_noise", parse_plain_number, 0.0, (NOT_NEGATIVE,))
"""Standard deviation, 1 = white."""


def add_gaussian(sigma: float, source: EffectRandom) -> TileOperation:
    """Return what adds normal noise to a tile of a picture in [0, 1], clipped to that.

    Black gains 0.399 sigma on average (errata E39).

    Parameters
    ----------
    sigma : float
        Standard deviation, 1 = white.
    source : EffectRandom
        Passed in, never shared between effects (errata EC5).
    """
    add = add_normal_noise(sigma, source)

    def work(part: Image, tile: Tile) -> None:
        """Add the noise of a tile in place and clip."""
        add(part, tile)
        np.clip(part, 0.0, 1.0, out=part)

    return work


def operation(view: View) -> TileOperation:
    """Return what adds the camera's normal noise to a tile, then clips."""
    return add_gaussian(view.camera[GAUSSIAN_NOISE], effect_random(view, "gaussian noise"))


def _largest_noise(view: View) -> float:
    """Return the largest deviation that the noise can make, 1 = white."""
    return FARTHEST * view.camera[GAUSSIAN_NOISE]


EFFECT = Effect(
    name="gaussian noise",
    answers=("gaussian noise", "noise", "snr", "histogram"),
    settings=(GAUSSIAN_NOISE,),
    is_present=lambda view: view.camera[GAUSSIAN_NOISE] > 0.0,
    run=PointByPoint(operation),
    omission_bound=lambda signal, view: signal.outside(0.0, 1.0) + _largest_noise(view),
    range_after=lambda signal, view: signal.with_margins(
        _largest_noise(view), _largest_noise(view)
    ).clip_range(0.0, 1.0),
    size=EffectSize(
        lambda view: 255.0 * view.camera[GAUSSIAN_NOISE], "add noise of {:.3g} grey levels", 2.0
    ),
    speckles=True,
)
