"""Read noise of the read-out chain."""

from __future__ import annotations

import math

from msgspec.structs import replace

from quizgen.camera.blocks import Work
from quizgen.camera.body import NEEDS_FULL_WELL
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.facts import REACH, Error, Facts
from quizgen.camera.noise import electrons_at_white, luck, noisier, normal_noise
from quizgen.camera.settings import NOT_NEGATIVE, Setting
from quizgen.camera.values import quantity
from quizgen.camera.view import View

READ_NOISE = Setting("read_noise", quantity("e-"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE))
"""Standard deviation in electrons."""


def _sigma(view: View) -> float:
    return view.camera[READ_NOISE] / electrons_at_white(view)


def work(view: View, rung: str = "") -> Work:
    """Add normal noise."""
    return normal_noise(_sigma(view), luck(view, "read noise"))


def skipped(facts: Facts, view: View) -> Error:
    """Its standard deviation."""
    return Error(0.0, _sigma(view))


def carried(error: Error, facts: Facts, view: View) -> Error:
    """Noise takes white below 1 again, and with it part of what a full well would have held back.

    Only that limit stands before, so that what lies beyond is above 1. Luck ends before `REACH`.
    What is rare has got luck of both pictures on it.
    """
    sigma = _sigma(view)
    if error.rare:
        error = replace(error, dither=math.hypot(error.dither, sigma))
    far = REACH * sigma
    if not error.beyond or not far:
        return error
    return error.plus(Error(bright=min(error.beyond, far), level=1.0 - far))


def after(facts: Facts, view: View) -> Facts:
    """Noisier."""
    return noisier(facts, skipped(facts, view))


EFFECT = Effect(
    name="read noise",
    stage="sensor",
    decides=("read noise", "dynamic range", "noise", "snr", "histogram"),
    settings=(READ_NOISE,),
    present=lambda view: view.camera[READ_NOISE] > 0.0,
    run=PointByPoint(work),
    cost=measured((2.72, 122)),
    skipped=skipped,
    carried=carried,
    knows_where=True,
    after=after,
    random=True,
)
