"""Full well: a photosite holds no more."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.effects.effect import (
    Effect,
    PointByPoint,
)
from quizgen.camera.scene import Image
from quizgen.camera.setup.body import FULL_WELL
from quizgen.camera.view import View


def work(view: View) -> Work:
    """A photosite holds no more than its full well."""

    def full(part: Image, _: Tile) -> None:
        np.clip(part, -math.inf, 1.0, out=part)  # takes half as long as a minimum with a number

    return full


EFFECT = Effect(
    name="full well",
    stage="sensor",
    answers=("clipping", "saturation", "dynamic range"),
    is_present=lambda view: view.camera[FULL_WELL] is not None,
    run=PointByPoint(work),
    omission_bound=lambda signal, _: signal.outside(-math.inf, 1.0),
    range_after=lambda signal, _: signal.clipped(-math.inf, 1.0),
)
