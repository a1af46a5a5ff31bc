"""Exposure: everything times 2^stops."""

from __future__ import annotations

import numpy as np

from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, on_picture
from quizgen.camera.facts import Error, Facts
from quizgen.camera.scene import Image
from quizgen.camera.settings import Setting, between
from quizgen.camera.values import quantity
from quizgen.camera.view import View

EXPOSURE = Setting("exposure", quantity("stop"), 0.0, (between(-40.0, 40.0, "stop"),))
"""Stops; +1 doubles."""


def run(image: Image, view: View, rung: str = "") -> Image:
    """Multiply by 2^stops."""
    return image * np.float32(2.0 ** view.camera[EXPOSURE])


def skipped(facts: Facts, view: View) -> Error:
    """Largest value times the missing factor."""
    return facts.amplified(abs(2.0 ** view.camera[EXPOSURE] - 1.0))


def carried(error: Error, facts: Facts, view: View) -> Error:
    """Errors are amplified too."""
    return error.times(2.0 ** view.camera[EXPOSURE])


def after(facts: Facts, view: View) -> Facts:
    """Everything times the factor."""
    return facts.scaled(2.0 ** view.camera[EXPOSURE])


EFFECT = Effect(
    name="exposure",
    stage="sensor",
    decides=("exposure",),
    settings=(EXPOSURE,),
    present=lambda view: view.camera[EXPOSURE] != 0.0,
    run=on_picture(run),
    cost=measured((0.0786, 18)),
    skipped=skipped,
    carried=carried,
    after=after,
)
