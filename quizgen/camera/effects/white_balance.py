"""White balance: a gain per channel."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.pixels.tiles import TILE_VALUES, Tile, TileOperation
from quizgen.camera.setup.scene import Colour, Image
from quizgen.camera.setup.settings import NOT_NEGATIVE, Setting, SettingRule
from quizgen.camera.setup.value_parsers import parse_triple
from quizgen.camera.setup.view import Signal, View

WHITE_BALANCE = Setting(
    "white_balance",
    parse_triple,
    (1.0, 1.0, 1.0),
    (SettingRule[Colour](lambda gains, _: min(gains) >= 0.0, NOT_NEGATIVE.message),),
)
"""Gains of red, green and blue."""


def operation(view: View) -> TileOperation:
    """Return what multiplies the channels of a tile by the camera's gains."""
    gains = np.tile(np.asarray(view.camera[WHITE_BALANCE], view.precision), TILE_VALUES // 3)

    def balance_channels(part: Image, _: Tile) -> None:
        """Multiply a tile in place."""
        part *= gains[: part.size]

    return balance_channels


def omission_bound(signal: Signal, view: View) -> float:
    """Return the largest value times the distance of the farthest gain from 1."""
    return max(abs(gain - 1.0) for gain in view.camera[WHITE_BALANCE]) * signal.size


def carry_error(error: float, signal: Signal, view: View) -> float:
    """Return the error times the largest gain."""
    gains = view.camera[WHITE_BALANCE]
    return error * max(gains)


def range_after(signal: Signal, view: View) -> Signal:
    """Return the range, scaled by gains between the smallest and the largest."""
    gains = view.camera[WHITE_BALANCE]
    return signal.scale_range(min(gains), max(gains))


EFFECT = Effect(
    name="white balance",
    answers=("white balance",),
    settings=(WHITE_BALANCE,),
    is_present=lambda view: view.camera[WHITE_BALANCE] != (1.0, 1.0, 1.0),
    run=PointByPoint(operation),
    omission_bound=omission_bound,
    carry_error=carry_error,
    range_after=range_after,
    needs_effects=("colour filters",),
)
