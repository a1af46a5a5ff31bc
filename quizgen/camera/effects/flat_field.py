"""Flat field: vignetting divided out of the linear data."""

from __future__ import annotations

import numpy as np
from msgspec.structs import replace

from quizgen.camera.blocks import Work, at_pixels
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.effects.vignetting import corner_light, fall_off_map, steepest_fall_off
from quizgen.camera.effects.vignetting import present as vignettes
from quizgen.camera.facts import Error, Facts
from quizgen.camera.scene import Image
from quizgen.camera.settings import Setting
from quizgen.camera.values import truth
from quizgen.camera.view import View

FLAT_FIELD = Setting("flat_field", truth, False)


def work(view: View, rung: str = "") -> Work:
    """Divide out the vignetting of an even picture: linear data, mean brightness kept (E31)."""
    return at_pixels(factors(fall_off_map(view), 0.0))


def factors(flat: Image, dark: Image | float) -> Image:
    """Mean of (flat - dark) over its values: what flat-field correction multiplies by.

    Parameters
    ----------
    flat, dark : numpy.ndarray
        Linear pictures of an even surface, and with the lens covered.

    Raises
    ------
    ValueError
        If a flat pixel is not brighter than its dark value (a dead pixel has no correction).
    """
    light = flat - dark
    if light.min() <= 0:
        raise ValueError("a flat pixel is not brighter than the dark frame")
    return float(light.mean(dtype=np.float64)) / light


def _gain(view: View) -> tuple[float, float]:
    """Smallest and largest factor of the flat-field correction."""
    corner = corner_light(view)
    return corner, 1.0 / corner


def skipped(facts: Facts, view: View) -> Error:
    """The mean lies between corner and centre, so factors lie between V and 1/V of the corner."""
    return facts.amplified(_gain(view)[1] - 1.0)


def carried(error: Error, facts: Facts, view: View) -> Error:
    """Amplified most at the corner."""
    return error.times(_gain(view)[1])


def after(facts: Facts, view: View) -> Facts:
    """Brighter, and steeper where the fall-off is divided out."""
    gain = _gain(view)[1]
    grown = facts.scaled(gain)
    step = (facts.size + facts.reach) * gain * gain * steepest_fall_off(view)
    low = min(facts.low * _gain(view)[0], grown.low)
    limits = min(facts.limits[0] * _gain(view)[0], grown.limits[0]), grown.limits[1]
    steep = grown.with_jump((grown.jump[0] + step, grown.jump[1] + step))
    return replace(steep, low=low, limits=limits)


EFFECT = Effect(
    name="flat field",
    stage="processing",
    decides=("flat field", "vignetting"),
    settings=(FLAT_FIELD,),
    present=lambda view: view.camera[FLAT_FIELD] and vignettes(view),
    run=PointByPoint(work),
    cost=measured((1.07, 111)),
    skipped=skipped,
    carried=carried,
    after=after,
    needs="vignetting",
)
