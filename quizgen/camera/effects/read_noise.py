"""Read noise of the read-out chain."""

from __future__ import annotations

from quizgen.camera.blocks import Work
from quizgen.camera.effects.effect import (
    Effect,
    PointByPoint,
    Size,
)
from quizgen.camera.noise import FARTHEST, electrons_at_white, luck, normal_noise
from quizgen.camera.setup.body import NEEDS_FULL_WELL
from quizgen.camera.setup.settings import NOT_NEGATIVE, Setting
from quizgen.camera.setup.values import quantity
from quizgen.camera.view import View

READ_NOISE = Setting("read_noise", quantity("e-"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE))
"""Standard deviation in electrons."""


def _sigma(view: View) -> float:
    return view.camera[READ_NOISE] / electrons_at_white(view)


def work(view: View) -> Work:
    """Add normal noise."""
    return normal_noise(_sigma(view), luck(view, "read noise"))


def farthest(view: View) -> float:
    """How far it carries a value, 1 = white."""
    return FARTHEST * _sigma(view)


EFFECT = Effect(
    name="read noise",
    stage="sensor",
    answers=("read noise", "dynamic range", "noise", "snr", "histogram"),
    settings=(READ_NOISE,),
    is_present=lambda view: view.camera[READ_NOISE] > 0.0,
    run=PointByPoint(work),
    omission_bound=lambda _, view: farthest(view),
    range_after=lambda signal, view: signal.widened(farthest(view), farthest(view)),
    size=Size(lambda view: view.camera[READ_NOISE], "add noise of {:.3g} electrons"),
    speckles=True,
)
