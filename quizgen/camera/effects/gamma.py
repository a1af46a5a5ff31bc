"""Gamma: linear light encoded for display."""

from __future__ import annotations

import math

from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.pixels.tiles import TileOperation
from quizgen.camera.pixels.tone_curve import (
    CURVE_ERROR,
    encode_exact,
    encode_piecewise,
    encode_value,
)
from quizgen.camera.setup.settings import Setting, SettingRule
from quizgen.camera.setup.value_parsers import parse_plain_number
from quizgen.camera.setup.view import Signal, View


def _parse_gamma(value: object) -> str | float:
    """Return ``srgb`` or an exponent from the value of a scene file."""
    return str(value) if value in ("srgb", "linear") else parse_plain_number(value)


_KNOWN = SettingRule[str | float](
    lambda gamma, _: gamma in ("linear", "srgb") if isinstance(gamma, str) else 1 <= gamma <= 100,
    "must be 'linear', 'srgb' or a number from 1 to 100",
)
GAMMA = Setting[str | float]("gamma", _parse_gamma, "linear", (_KNOWN,))


def operation(view: View) -> TileOperation:
    """Return what encodes the linear light of a tile for display, clipped to [0, 1]."""
    encode = encode_piecewise if view.precision == "float32" else encode_exact
    return encode(view.camera[GAMMA])


def _find_unit_slope(gamma: str | float) -> float:
    """Return the value in [0, 1] at which a tone curve has the slope 1.

    There it is farthest from the diagonal.
    """
    if gamma == "srgb":
        return (1.055 / 2.4) ** (2.4 / 1.4)
    exponent = float(gamma)
    return math.exp(-exponent / (exponent - 1.0) * math.log(exponent))


def omission_bound(signal: Signal, view: View) -> float:
    """Return the largest distance of the tone curve from the diagonal, and what it clips."""
    low, high = max(0.0, min(signal.low, 1.0)), min(1.0, max(signal.high, 0.0))
    gamma = view.camera[GAMMA]
    # a concave curve is farthest from the diagonal where it is as steep, or at the nearest end
    farthest = min(max(low, _find_unit_slope(gamma)), high)
    gap = encode_value(farthest, gamma) - farthest
    return signal.outside(0.0, 1.0) + gap + CURVE_ERROR


def carry_error(error: float, signal: Signal, view: View) -> float:
    """Return the error after encoding.

    Tone curves are concave and spread the darkest values most.
    """
    start, gamma = max(0.0, signal.low - error), view.camera[GAMMA]
    return encode_value(start + error, gamma) - encode_value(start, gamma) + CURVE_ERROR


def range_after(signal: Signal, view: View) -> Signal:
    """Return the encoded range."""
    gamma = view.camera[GAMMA]
    ends = encode_value(signal.low, gamma), encode_value(signal.high, gamma)
    return Signal(*ends).with_margins(CURVE_ERROR, CURVE_ERROR)


EFFECT = Effect(
    name="gamma",
    answers=("gamma",),
    settings=(GAMMA,),
    is_present=lambda view: view.camera[GAMMA] not in ("linear", 1.0),
    run=PointByPoint(operation),
    omission_bound=omission_bound,
    carry_error=carry_error,
    range_after=range_after,
    always="screens and printers expect it",
)
