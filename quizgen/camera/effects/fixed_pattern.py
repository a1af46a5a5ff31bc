"""Fixed pattern: what every photosite adds by itself, the same in all pictures of a camera."""

from __future__ import annotations

from dataclasses import replace

import msgspec

from quizgen.camera.effect import Effect, EffectSize, PointByPoint
from quizgen.camera.pixels.noise import (
    FARTHEST,
    add_normal_noise,
    effect_random,
    electrons_at_white,
)
from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import NEEDS_FULL_WELL, NOT_NEGATIVE, Setting
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import Signal, View

FIXED_PATTERN = Setting(
    "fixed_pattern", quantity_parser("e-"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE)
)
"""Standard deviation of the offsets of the photosites, e- (DSNU of EMVA 1288)."""
BIAS = Setting("bias", quantity_parser("e-"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE))
"""Pedestal of all photosites, e-: it keeps noise around black from being clipped."""


def pedestal(view: View) -> float:
    """Return the pedestal, the constant added before conversion, 1 = white."""
    return view.camera[BIAS] / electrons_at_white(view)


def operation(view: View) -> TileOperation:
    """Return what adds pedestal and fixed offsets to a tile.

    They do not depend on the scene's seed.
    """
    camera = msgspec.structs.replace(view, scene=replace(view.scene, seed=0))
    sigma = view.camera[FIXED_PATTERN] / electrons_at_white(view)
    spread, bias = add_normal_noise(sigma, effect_random(camera, "fixed pattern")), pedestal(view)

    def add_pattern(part: Image, tile: Tile) -> None:
        """Add the offsets of a tile in place."""
        part += bias
        if sigma:
            spread(part, tile)

    return add_pattern


def farthest(view: View) -> float:
    """Return the largest offset of any photosite, 1 = white."""
    return FARTHEST * view.camera[FIXED_PATTERN] / electrons_at_white(view)


def range_after(signal: Signal, view: View) -> Signal:
    """Return the range, brighter by the pedestal and wider by the offsets."""
    return signal.with_margins(farthest(view) - pedestal(view), farthest(view) + pedestal(view))


EFFECT = Effect(
    name="fixed pattern",
    answers=("fixed pattern", "noise"),
    settings=(FIXED_PATTERN, BIAS),
    is_present=lambda view: view.camera[FIXED_PATTERN] > 0.0 or view.camera[BIAS] > 0.0,
    run=PointByPoint(operation),
    omission_bound=lambda _, view: pedestal(view) + farthest(view),
    range_after=range_after,
    size=EffectSize(
        lambda view: view.camera[FIXED_PATTERN], "spread the offsets by {:.3g} electrons"
    ),
    speckles=True,
)
