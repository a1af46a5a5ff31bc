"""White balance: a gain per channel."""

from __future__ import annotations

import numpy as np

from quizgen.camera.blocks import BLOCK, Tile, Work
from quizgen.camera.effects.effect import Effect, PointByPoint
from quizgen.camera.scene import Colour, Image
from quizgen.camera.setup.settings import NOT_NEGATIVE, Rule, Setting, Settings
from quizgen.camera.setup.values import triple
from quizgen.camera.view import Signal, View


def _no_gain_negative(gains: Colour, _: Settings) -> bool:
    return min(gains) >= 0.0


WHITE_BALANCE = Setting(
    "white_balance", triple, (1.0, 1.0, 1.0), (Rule(_no_gain_negative, NOT_NEGATIVE.message),)
)
"""Gains of red, green and blue."""


def work(view: View) -> Work:
    """Multiply the channels by their gains."""
    gains = np.tile(np.asarray(view.camera[WHITE_BALANCE], view.precision), BLOCK // 3)

    def balanced(part: Image, _: Tile) -> None:
        part *= gains[: part.size]

    return balanced


def omission_bound(signal: Signal, view: View) -> float:
    """Largest value times the gain farthest from 1."""
    return max(abs(gain - 1.0) for gain in view.camera[WHITE_BALANCE]) * signal.size


def carry_error(error: float, signal: Signal, view: View) -> float:
    """Amplified by the largest gain."""
    gains = view.camera[WHITE_BALANCE]
    return error * max(gains)


def range_after(signal: Signal, view: View) -> Signal:
    """Scaled by gains between the smallest and the largest."""
    gains = view.camera[WHITE_BALANCE]
    return signal.scaled(min(gains), max(gains))


EFFECT = Effect(
    name="white balance",
    stage="processing",
    answers=("white balance",),
    settings=(WHITE_BALANCE,),
    is_present=lambda view: view.camera[WHITE_BALANCE] != (1.0, 1.0, 1.0),
    run=PointByPoint(work),
    omission_bound=omission_bound,
    carry_error=carry_error,
    range_after=range_after,
    needs_effects=("colour filters",),
)
