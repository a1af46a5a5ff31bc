"""Gamma: linear light encoded for display."""

from __future__ import annotations

import math

from quizgen.camera.blocks import Work
from quizgen.camera.effects.effect import Effect, PointByPoint
from quizgen.camera.power import CURVE_ERROR, encode_number, encoder
from quizgen.camera.setup.settings import Rule, Setting, Settings
from quizgen.camera.setup.values import number
from quizgen.camera.view import Signal, View


def _read(value: object) -> str | float:
    return str(value) if value in ("srgb", "linear") else number(value)


def _known(gamma: str | float, _: Settings) -> bool:
    if isinstance(gamma, str):
        return gamma in ("linear", "srgb")
    return 1.0 <= gamma <= 100.0


GAMMA = Setting[str | float](
    "gamma", _read, "linear", (Rule(_known, "must be 'linear', 'srgb' or a number from 1 to 100"),)
)


def work(view: View) -> Work:
    """Encode linear light for display; clips to [0, 1]."""
    return encoder(view.camera[GAMMA], view.precision)


def _as_steep(gamma: str | float) -> float:
    """Where a tone curve rises as steeply as the diagonal."""
    if gamma == "srgb":
        return (1.055 / 2.4) ** (2.4 / 1.4)
    exponent = float(gamma)
    return math.exp(-exponent / (exponent - 1.0) * math.log(exponent))


def omission_bound(signal: Signal, view: View) -> float:
    """Largest distance of the curve from the diagonal over the range, and what it clips."""
    low, high = max(0.0, min(signal.low, 1.0)), min(1.0, max(signal.high, 0.0))
    gamma = view.camera[GAMMA]
    # a concave curve is farthest from the diagonal where it is as steep, or at the nearest end
    farthest = min(max(low, _as_steep(gamma)), high)
    gap = encode_number(farthest, gamma) - farthest
    return signal.outside(0.0, 1.0) + gap + CURVE_ERROR


def carry_error(error: float, signal: Signal, view: View) -> float:
    """Tone curves are concave: the darkest values are spread most."""
    start, gamma = max(0.0, signal.low - error), view.camera[GAMMA]
    return encode_number(start + error, gamma) - encode_number(start, gamma) + CURVE_ERROR


def range_after(signal: Signal, view: View) -> Signal:
    """Encoded."""
    gamma = view.camera[GAMMA]
    ends = encode_number(signal.low, gamma), encode_number(signal.high, gamma)
    return Signal(*ends).widened(CURVE_ERROR, CURVE_ERROR)


EFFECT = Effect(
    name="gamma",
    stage="processing",
    answers=("gamma",),
    settings=(GAMMA,),
    is_present=lambda view: view.camera[GAMMA] not in ("linear", 1.0),
    run=PointByPoint(work),
    omission_bound=omission_bound,
    carry_error=carry_error,
    range_after=range_after,
    always="screens and printers expect it",
)
