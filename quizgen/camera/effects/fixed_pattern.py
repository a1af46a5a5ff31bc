"""Fixed pattern: what every photosite adds by itself, the same in all pictures of a camera."""

from __future__ import annotations

from dataclasses import replace

import msgspec

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.effects.effect import Effect, PointByPoint, Size
from quizgen.camera.noise import FARTHEST, electrons_at_white, luck, normal_noise
from quizgen.camera.scene import Image
from quizgen.camera.setup.body import NEEDS_FULL_WELL
from quizgen.camera.setup.settings import NOT_NEGATIVE, Setting
from quizgen.camera.setup.values import quantity
from quizgen.camera.view import Signal, View

FIXED_PATTERN = Setting("fixed_pattern", quantity("e-"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE))
"""Standard deviation of the offsets of the photosites, e- (DSNU of EMVA 1288)."""
BIAS = Setting("bias", quantity("e-"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE))
"""Pedestal of all photosites, e-: it keeps noise around black from being clipped."""


def level(view: View) -> float:
    """The pedestal, 1 = white."""
    return view.camera[BIAS] / electrons_at_white(view)


def work(view: View) -> Work:
    """Add pedestal and offsets: they do not depend on the scene's seed."""
    camera = msgspec.structs.replace(view, scene=replace(view.scene, seed=0))
    sigma = view.camera[FIXED_PATTERN] / electrons_at_white(view)
    spread, bias = normal_noise(sigma, luck(camera, "fixed pattern")), level(view)

    def lifted(part: Image, tile: Tile) -> None:
        part += bias
        if sigma:
            spread(part, tile)

    return lifted


def farthest(view: View) -> float:
    """The largest offset, 1 = white."""
    return FARTHEST * view.camera[FIXED_PATTERN] / electrons_at_white(view)


def range_after(signal: Signal, view: View) -> Signal:
    """Brighter by the pedestal, and spread."""
    return signal.widened(farthest(view) - level(view), farthest(view) + level(view))


EFFECT = Effect(
    name="fixed pattern",
    stage="sensor",
    answers=("fixed pattern", "noise"),
    settings=(FIXED_PATTERN, BIAS),
    is_present=lambda view: view.camera[FIXED_PATTERN] > 0.0 or view.camera[BIAS] > 0.0,
    run=PointByPoint(work),
    omission_bound=lambda _, view: level(view) + farthest(view),
    range_after=range_after,
    size=Size(lambda view: view.camera[FIXED_PATTERN], "spread the offsets by {:.3g} electrons"),
    speckles=True,
)
