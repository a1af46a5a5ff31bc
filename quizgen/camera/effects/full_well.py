"""Full well: a photosite holds no more."""

from __future__ import annotations

import math

import numpy as np
from msgspec.structs import replace

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.body import FULL_WELL
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.facts import Error, Facts
from quizgen.camera.scene import Image
from quizgen.camera.view import View


def work(view: View, rung: str = "") -> Work:
    """A photosite holds no more than its full well."""

    def full(part: Image, _: Tile) -> None:
        np.clip(part, -math.inf, 1.0, out=part)  # takes half as long as a minimum with a number

    return full


def skipped(facts: Facts, view: View) -> Error:
    """What would stand above the full well, by rounding at least, until something clips it."""
    out = facts.outside(-math.inf, 1.0)
    return Error(odd=out.odd, beyond=facts.just_above(1.0) + out.sure)


def carried(error: Error, facts: Facts, view: View) -> Error:
    """No difference grows; the light ends at white."""
    error = error.capped(facts.high)
    return replace(error, level=min(error.level, 1.0)) if error.bright else error


def after(facts: Facts, view: View) -> Facts:
    """No more than 1; clipping may bend."""
    capped = replace(facts, high=min(facts.high, 1.0), low=min(facts.low, 1.0))
    capped = capped.between(-math.inf, 1.0)
    return capped.with_jump(facts.jump) if facts.top > 1.0 else capped


EFFECT = Effect(
    name="full well",
    stage="sensor",
    decides=("clipping", "saturation", "dynamic range"),
    present=lambda view: view.camera[FULL_WELL] is not None,
    run=PointByPoint(work),
    cost=measured((0.524, 38.5)),
    skipped=skipped,
    carried=carried,
    knows_where=True,
    after=after,
)
