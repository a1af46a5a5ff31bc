"""Full well: a photosite holds no more."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import FULL_WELL
from quizgen.camera.setup.view import View


def operation(view: View) -> TileOperation:
    """Return what clips a tile at the full well, 1 = white."""

    def full(part: Image, _: Tile) -> None:
        """Clip a tile in place."""
        np.clip(part, -math.inf, 1.0, out=part)  # takes half as long as a minimum with a number

    return full


EFFECT = Effect(
    name="full well",
    answers=("clipping", "saturation", "dynamic range"),
    is_present=lambda view: view.camera[FULL_WELL] is not None,
    run=PointByPoint(operation),
    omission_bound=lambda signal, _: signal.outside(-math.inf, 1.0),
    range_after=lambda signal, _: signal.clip_range(-math.inf, 1.0),
)
