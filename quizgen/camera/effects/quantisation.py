"""Quantisation: the codes of the converter."""

from __future__ import annotations

import math

import numpy as np
from msgspec.structs import replace

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.facts import BEYOND_CERTAIN, REACH, Error, Facts, LayerFacts
from quizgen.camera.scene import Image
from quizgen.camera.settings import Setting, between
from quizgen.camera.values import whole
from quizgen.camera.view import View

BIT_DEPTH = Setting[int | None]("bit_depth", whole, None, (between(1, 16),))
"""Bits of the converter; None is analog."""


def _largest_code(view: View) -> int:
    return (1 << (view.camera[BIT_DEPTH] or 16)) - 1


def work(view: View, rung: str = "") -> Work:
    """Clip to [0, 1] and round to the converter's codes, halves upward."""
    top = float(_largest_code(view))

    def coded(part: Image, _: Tile) -> None:
        part *= top
        part += 0.5
        np.floor(part, out=part)
        np.clip(part, 0.0, top, out=part)
        part /= top

    return coded


def _step(view: View) -> float:
    """One code, 1 = full scale."""
    return 1.0 / _largest_code(view)


def skipped(facts: Facts, view: View) -> Error:
    """Half a code, and what the converter would clip, until something else does."""
    out = facts.outside(0.0, 1.0)
    return Error(_step(view) / 2.0, odd=out.odd, beyond=out.sure)


def carried(error: Error, facts: Facts, view: View) -> Error:
    """Any difference may become a whole code; with luck after it, it does so now and then.

    Several small differences may be followed one by one, or as one.
    """
    step, error = _step(view), error.capped(facts.high)
    if error.beyond or error.bright:
        bright, level = _whole(error.bright, step), min(error.level, 1.0) - step
        rest = _coded(replace(error, beyond=0.0, bright=0.0, level=math.inf), step)
        return replace(rest, bright=bright, level=level) if bright else rest
    return _coded(error, step)


def _coded(error: Error, step: float) -> Error:
    """What is everywhere, or at few places, after rounding."""
    if not error.sigma and not error.rare:
        return replace(error, sure=_whole(error.sure, step))
    apart, together = _apart(error, step), _together(error, step)
    return apart if apart.total <= together.total else together


def _apart(error: Error, step: float) -> Error:
    """Codes of what is sure, of luck and of what is rare."""
    if error.rare:
        chance = min(1.0, between_codes(error.rare, error.dither, step))
        error = replace(error, rare=_whole(error.rare, step), share=error.share * chance)
    if error.root:  # a code may be half a step darker than its value
        flat = error.flat + error.root * math.sqrt(step / 2.0)
        error = replace(error, flat=flat)
    if error.sigma:
        return error.more(step)
    return replace(error, sure=_whole(error.sure, step))


def _together(error: Error, step: float) -> Error:
    """Codes of all that nearly every value keeps, as one difference."""
    beyond = BEYOND_CERTAIN if error.sigma else 0.0
    return Error(_whole(error.certain, step), odd=error.odd + beyond)


def between_codes(apart: float, sigma: float, step: float) -> float:
    """Bound on the chance that a border between two codes lies between two values.

    Parameters
    ----------
    apart : float
        How far apart they are.
    sigma : float
        Standard deviation of normal luck that is then added to both.
    step : float
        From one border to the next.

    Notes
    -----
    The law of the luck, taken modulo a step, has no density above 1 + 2 sum_k q^(k^2) per step with
    q = exp(-2 (pi sigma/step)^2), nor above that of a border every step and one at its top. It is a
    table of 2^16 values, within 8e-6 of the normal distribution function and shorter than `REACH`;
    borders are rounded.
    """
    if not sigma:
        return 1.0
    q = math.exp(-2.0 * (math.pi * sigma / step) ** 2)
    ripple = min(2.0 * q / (1.0 - q**3), step / (sigma * math.sqrt(2.0 * math.pi)))
    borders = 2.0 + 2.0 * REACH * sigma / step
    density = (1.0 + ripple) * math.exp(_ROUNDED / sigma)
    return apart / step * density + _TABLE * borders


_ROUNDED = 1e-6
"""`REACH` times how far single precision moves a border, at most."""
_TABLE = 1.6e-5


def _whole(difference: float, step: float) -> float:
    """The codes that a difference may become."""
    return math.ceil(difference / step - 1e-9) * step


def after(facts: Facts, view: View) -> Facts:
    """Clipped; steps grow by up to a code, bends by two."""
    step = _step(view)
    clipped = facts.top > 1.0 or facts.bottom < 0.0
    jump = facts.jump[0] + step, facts.jump[1] + step
    bend = facts.bend[0] + 2 * step, facts.bend[1] + 2 * step
    low = min(max(facts.low - step / 2, 0.0), 1.0)
    high = max(min(facts.high + step / 2, 1.0), 0.0)
    if clipped:
        bend = 2 * jump[0], 2 * jump[1]
    coded = replace(facts, low=low, high=high, layers=(LayerFacts(jump, bend),))
    return replace(coded, limits=(0.0, min(1.0, facts.limits[1] + step / 2)))


EFFECT = Effect(
    name="quantisation",
    stage="sensor",
    decides=("quantisation", "bit depth"),
    settings=(BIT_DEPTH,),
    present=lambda view: view.camera[BIT_DEPTH] is not None,
    run=PointByPoint(work),
    cost=measured((0.68, 44.7)),
    skipped=skipped,
    carried=carried,
    knows_where=True,
    after=after,
)
