"""Normalisation: one range of values stretched to another."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import Setting, SettingRule
from quizgen.camera.setup.value_parsers import list_parser, parse_plain_number
from quizgen.camera.setup.view import Signal, View

Ends = tuple[float, float, float, float]


def _parse_ends(value: object) -> Ends:
    """Return (min, max, new min, new max) from a list of four numbers, 1 = white."""
    low, high, new_low, new_high = list_parser(parse_plain_number, 4)(value)
    return low, high, new_low, new_high


NARROWEST = 1e-6
"""Least width of a range that is stretched."""


_RISES = SettingRule[Ends | None](
    lambda ends, _: ends is None or ends[1] - ends[0] >= NARROWEST,
    f"needs max - min >= {NARROWEST:g}",
)
NORMALISE = Setting[Ends | None]("normalise", _parse_ends, None, (_RISES,))
"""min, max, new min, new max; 1 = white."""


def _value_range(view: View) -> Ends:
    """Return the camera's (min, max, new min, new max); those that change nothing by default."""
    return view.camera[NORMALISE] or (0.0, 1.0, 0.0, 1.0)


def stretch_range(
    image: Image, low: float, high: float, new_low: float = 0.0, new_high: float = 1.0
) -> Image:
    """Return a picture with [low, high] mapped to [new_low, new_high], clipped to both (E44)."""
    low, high, new_low, new_high = map(float, (low, high, new_low, new_high))
    share = (image - low) * (1.0 / (high - low))
    np.clip(share, 0.0, 1.0, out=share)
    share *= new_high - new_low
    share += new_low
    return share


def operation(view: View) -> TileOperation:
    """Return what stretches and clips a tile by the camera's limits."""
    ends = _value_range(view)

    def stretch_values(part: Image, _: Tile) -> None:
        """Stretch a tile in place."""
        part[...] = stretch_range(part, *ends)

    return stretch_values


def _stretch_number(value: float, view: View) -> float:
    """Return one number stretched and clipped by the camera's limits."""
    low, high, new_low, new_high = _value_range(view)
    return new_low + (new_high - new_low) * min(max((value - low) / (high - low), 0.0), 1.0)


def omission_bound(signal: Signal, view: View) -> float:
    """Return the largest change: at an end of the range, or where clipping begins."""
    ends = (signal.low, signal.high, _value_range(view)[0], _value_range(view)[1])
    inside = [value for value in ends if signal.low <= value <= signal.high]
    return max(abs(_stretch_number(value, view) - value) for value in inside)


def carry_error(error: float, signal: Signal, view: View) -> float:
    """Return the error times the stretch."""
    low, high, new_low, new_high = _value_range(view)
    return error * abs(new_high - new_low) / (high - low)


def range_after(signal: Signal, view: View) -> Signal:
    """Return the range, stretched and clipped."""
    ends = _stretch_number(signal.low, view), _stretch_number(signal.high, view)
    return Signal(min(ends), max(ends))


EFFECT = Effect(
    name="normalisation",
    answers=("normalisation", "contrast"),
    settings=(NORMALISE,),
    is_present=lambda view: view.camera[NORMALISE] is not None,
    run=PointByPoint(operation),
    omission_bound=omission_bound,
    carry_error=carry_error,
    range_after=range_after,
)
