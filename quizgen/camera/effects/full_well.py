"""Full well: a photosite holds no more."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from quizgen.camera.body import FULL_WELL
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, on_picture
from quizgen.camera.facts import Error, Facts
from quizgen.camera.scene import Image
from quizgen.camera.view import View


def run(image: Image, view: View, rung: str = "") -> Image:
    """A photosite holds no more than its full well."""
    return np.minimum(image, np.float32(1.0))


def skipped(facts: Facts, view: View) -> Error:
    """What would stand above the full well."""
    return facts.outside(-math.inf, 1.0)


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
    run=on_picture(run),
    cost=measured((0.338, 25.9)),
    skipped=skipped,
    after=after,
)
