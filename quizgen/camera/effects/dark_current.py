"""Dark current: charge without light, with its own shot noise, and hot pixels."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, PointByPoint
from quizgen.camera.pixels.noise import WORDS, effect_random, electrons_at_white, farthest_count
from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image, Precision
from quizgen.camera.setup.settings import (
    NEEDS_FULL_WELL,
    NOT_NEGATIVE,
    SHARE,
    SHUTTER,
    Setting,
    SettingRule,
)
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import Signal, View

MOST_CHARGE = 1e8
"""Electrons whose counts are still told apart one by one."""


_CHARGE = SettingRule[float](
    lambda current, camera: current * camera[SHUTTER] <= MOST_CHARGE,
    f"makes more than {MOST_CHARGE:g} e- while the shutter is open",
)
DARK_CURRENT = Setting(
    "dark_current", quantity_parser("e-/s"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE, _CHARGE)
)
HOT_PIXELS = Setting("hot_pixels", quantity_parser("%"), 0.0, (NEEDS_FULL_WELL, SHARE))
"""Share of photosites stuck at full well."""


def dark_electrons(view: View) -> float:
    """Return the mean dark charge per photosite, e-: current times exposure time."""
    return view.camera[DARK_CURRENT] * view.camera[SHUTTER]


def _build_count_table(mean: float, precision: Precision) -> Image:
    """Return Poisson counts of one mean at the middles of 2^16 equal probabilities.

    Read at random places, the table gives counts of this mean.
    """
    if not mean:
        return np.zeros(WORDS, precision)
    first = max(0, math.floor(mean - 12.0 * math.sqrt(mean) - 20.0))
    last = math.ceil(mean + 12.0 * math.sqrt(mean) + 40.0)
    chances = [
        math.exp(count * math.log(mean) - mean - math.lgamma(count + 1.0))
        for count in range(first, last)
    ]
    middles = (np.arange(WORDS) + 0.5) / WORDS
    return (np.searchsorted(np.cumsum(chances), middles, side="right") + first).astype(precision)


def operation(view: View) -> TileOperation:
    """Return what adds dark charge with its shot noise to a tile; hot pixels are set to white."""
    charge, stuck = effect_random(view, "dark current"), effect_random(view, "hot pixels")
    share, counts = (
        view.camera[HOT_PIXELS],
        _build_count_table(dark_electrons(view), view.precision),
    )
    signals = counts * (1.0 / electrons_at_white(view))

    def add_dark_current(part: Image, tile: Tile) -> None:
        """Add counts drawn from the table to a tile in place."""
        part += charge.draw_from_table(signals, tile.number, part.size)
        if share:
            part.reshape(-1, 3)[stuck.draw_uniform(tile.number, part.size // 3) < share] = 1.0

    return add_dark_current


def _largest_charge(view: View) -> float:
    """Return the largest dark charge that a pixel can get, 1 = white."""
    electrons = dark_electrons(view)
    return (electrons + farthest_count(electrons)) / electrons_at_white(view) if electrons else 0.0


def omission_bound(signal: Signal, view: View) -> float:
    """Return the largest dark charge, or with hot pixels how far white can be from a value."""
    return max(_largest_charge(view), signal.outside(1.0, 1.0) if view.camera[HOT_PIXELS] else 0.0)


def range_after(signal: Signal, view: View) -> Signal:
    """Return the range, brighter by the largest charge; hot pixels add white itself."""
    bright = signal.with_margins(0.0, _largest_charge(view))
    return bright.including(1.0, 1.0) if view.camera[HOT_PIXELS] else bright


EFFECT = Effect(
    name="dark current",
    answers=("dark current", "hot pixels", "noise", "snr", "histogram"),
    settings=(DARK_CURRENT, HOT_PIXELS),
    is_present=lambda view: dark_electrons(view) > 0.0 or view.camera[HOT_PIXELS] > 0.0,
    run=PointByPoint(operation),
    omission_bound=omission_bound,
    range_after=range_after,
    size=EffectSize(dark_electrons, "add {:.3g} electrons to a pixel"),
    speckles=True,
    needs="shutter",
)
