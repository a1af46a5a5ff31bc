"""Fixed pattern: what every photosite adds by itself, the same in all pictures of a camera."""

from __future__ import annotations

from dataclasses import replace

import msgspec

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.body import NEEDS_FULL_WELL
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.facts import Error, Facts
from quizgen.camera.noise import electrons_at_white, luck, noisier, normal_noise
from quizgen.camera.scene import Image
from quizgen.camera.settings import NOT_NEGATIVE, Setting
from quizgen.camera.values import quantity
from quizgen.camera.view import View

FIXED_PATTERN = Setting("fixed_pattern", quantity("e-"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE))
"""Standard deviation of the offsets of the photosites, e- (DSNU of EMVA 1288)."""
BIAS = Setting("bias", quantity("e-"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE))
"""Pedestal of all photosites, e-: it keeps noise around black from being clipped."""


def level(view: View) -> float:
    """The pedestal, 1 = white."""
    return view.camera[BIAS] / electrons_at_white(view)


def work(view: View, rung: str = "") -> Work:
    """Add pedestal and offsets: they do not depend on the scene's seed."""
    camera = msgspec.structs.replace(view, scene=replace(view.scene, seed=0))
    sigma = view.camera[FIXED_PATTERN] / electrons_at_white(view)
    spread, bias = normal_noise(sigma, luck(camera, "fixed pattern")), level(view)

    def lifted(part: Image, tile: Tile) -> None:
        part += bias
        if sigma:
            spread(part, tile)

    return lifted


def skipped(facts: Facts, view: View) -> Error:
    """The pedestal, and the spread of the offsets."""
    return Error(level(view), view.camera[FIXED_PATTERN] / electrons_at_white(view))


def carried(error: Error, facts: Facts, view: View) -> Error:
    """The same is added to both pictures: what stood beyond 0 or 1 may now stand anywhere."""
    return error.everywhere() if error.bright else error.within()


def after(facts: Facts, view: View) -> Facts:
    """Brighter by the pedestal; the offsets count as noise."""
    spread = msgspec.structs.replace(skipped(facts, view), sure=0.0)
    return noisier(facts.lifted(level(view)), spread)


EFFECT = Effect(
    name="fixed pattern",
    stage="sensor",
    decides=("fixed pattern", "dark frame", "noise"),
    settings=(FIXED_PATTERN, BIAS),
    present=lambda view: view.camera[FIXED_PATTERN] > 0.0 or view.camera[BIAS] > 0.0,
    run=PointByPoint(work),
    cost=measured((2.85, 126)),
    skipped=skipped,
    carried=carried,
    knows_where=True,
    after=after,
    random=True,
)
