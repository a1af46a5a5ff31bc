"""Read noise of the read-out chain."""

from __future__ import annotations

from quizgen.camera.effect import Effect, EffectSize, PointByPoint
from quizgen.camera.pixels.noise import (
    FARTHEST,
    add_normal_noise,
    effect_random,
    electrons_at_white,
)
from quizgen.camera.pixels.tiles import TileOperation
from quizgen.camera.setup.settings import NEEDS_FULL_WELL, NOT_NEGATIVE, Setting
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import View

READ_NOISE = Setting("read_noise", quantity_parser("e-"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE))
"""Standard deviation in electrons."""


def operation(view: View) -> TileOperation:
    """Return what adds the camera's read noise (normal) to a tile."""
    sigma = view.camera[READ_NOISE] / electrons_at_white(view)
    return add_normal_noise(sigma, effect_random(view, "read noise"))


def farthest(view: View) -> float:
    """Return the largest deviation that read noise can make, 1 = white."""
    return FARTHEST * (view.camera[READ_NOISE] / electrons_at_white(view))


EFFECT = Effect(
    name="read noise",
    answers=("read noise", "dynamic range", "noise", "snr", "histogram"),
    settings=(READ_NOISE,),
    is_present=lambda view: view.camera[READ_NOISE] > 0.0,
    run=PointByPoint(operation),
    omission_bound=lambda _, view: farthest(view),
    range_after=lambda signal, view: signal.with_margins(farthest(view), farthest(view)),
    size=EffectSize(lambda view: view.camera[READ_NOISE], "add noise of {:.3g} electrons"),
    speckles=True,
)
