"""Dark current: charge without light, with its own shot noise, and hot pixels."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from msgspec.structs import replace

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.body import NEEDS_FULL_WELL, SHUTTER
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.facts import Error, Facts
from quizgen.camera.noise import WORDS, electrons_at_white, luck, noisier, poisson_gap
from quizgen.camera.scene import Image, Precision
from quizgen.camera.settings import NOT_NEGATIVE, SHARE, Rule, Setting, Settings
from quizgen.camera.values import quantity
from quizgen.camera.view import View

MOST_CHARGE = 1e8
"""Electrons whose counts are still told apart one by one."""


def _not_flooded(current: float, camera: Settings) -> bool:
    return current * camera[SHUTTER] <= MOST_CHARGE


_CHARGE = Rule(_not_flooded, f"makes more than {MOST_CHARGE:g} e- while the shutter is open")
DARK_CURRENT = Setting(
    "dark_current", quantity("e-/s"), 0.0, (NEEDS_FULL_WELL, NOT_NEGATIVE, _CHARGE)
)
HOT_PIXELS = Setting("hot_pixels", quantity("%"), 0.0, (NEEDS_FULL_WELL, SHARE))
"""Share of photosites stuck at full well."""


def dark_electrons(view: View) -> float:
    """Mean dark charge per photosite, e-: current times exposure time."""
    return view.camera[DARK_CURRENT] * view.camera[SHUTTER]


def _poisson(mean: float, precision: Precision) -> Image:
    """Poisson counts of one mean in the middle of equal probabilities."""
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


_MOSTLY_NONE = WORDS * 15 // 16
"""Luck without an electron from which on it is faster to look for the places with one."""


def work(view: View, rung: str = "") -> Work:
    """Add the dark charge and its own shot noise; hot pixels are stuck at full well."""
    charge, stuck = luck(view, "dark current"), luck(view, "hot pixels")
    share, counts = view.camera[HOT_PIXELS], _poisson(dark_electrons(view), view.precision)
    signals = counts * (1.0 / electrons_at_white(view))
    first = int(np.searchsorted(signals, 0.0, side="right"))

    def darkened(part: Image, tile: Tile) -> None:
        if first <= _MOSTLY_NONE:
            part += charge.pick(signals, tile.number, part.size)
        elif first < WORDS:
            where, drawn = charge.beyond(first, tile.number, part.size)
            part[where] += signals[drawn]
        if share:
            part.reshape(-1, 3)[stuck.uniform(tile.number, part.size // 3) < share] = 1.0

    return darkened


def _noise(view: View) -> Error:
    """The dark charge's own shot noise."""
    electrons, well = dark_electrons(view), electrons_at_white(view)
    gap = poisson_gap(electrons) if electrons else 0.0
    return Error(gap / well, math.sqrt(electrons) / well)


def _mean(view: View) -> Error:
    return Error(dark_electrons(view) / electrons_at_white(view))


def skipped(facts: Facts, view: View) -> Error:
    """Mean charge and its noise, or few electrons at few places; a hot pixel may be anywhere."""
    if view.camera[HOT_PIXELS]:
        return Error(math.inf)
    electrons, charge = dark_electrons(view), _mean(view).plus(_noise(view))
    if electrons > _FEW:
        return charge
    largest, share = counted(electrons)
    counts = Error(rare=largest / electrons_at_white(view), share=share)
    return min(charge, counts, key=lambda error: error.certain)


_FEW = 16.0


@lru_cache(maxsize=64)
def counted(mean: float) -> tuple[int, float]:
    """Largest count in a table of `_poisson`, and the share that is not 0, of a mean up to 16.

    Its last place is half a step below probability 1.
    """
    chance, count = math.exp(-mean), 0
    reached, last = chance, 1.0 - 0.5 / WORDS + _SLACK
    while reached <= last:
        count += 1
        chance *= mean / count
        reached += chance
    return count, min(1.0, 0.5 / WORDS - math.expm1(-mean))


_SLACK = 1e-12
"""Rounding of sums of chances."""


def after(facts: Facts, view: View) -> Facts:
    """Brighter and noisier; hot pixels are steps of the whole range."""
    mean, (low, high) = _mean(view).sure, facts.limits
    lifted = replace(facts, high=facts.high + mean, limits=(low, high + mean))
    lifted = noisier(lifted, _noise(view), (0.0, 0.0))  # no charge makes anything darker
    if not view.camera[HOT_PIXELS]:
        return lifted
    low, high = lifted.limits
    lifted = replace(lifted, high=max(lifted.high, 1.0), limits=(low, max(high, 1.0)))
    return lifted.with_jump((lifted.span, lifted.span))


EFFECT = Effect(
    name="dark current",
    stage="sensor",
    decides=("dark current", "hot pixels", "noise", "snr", "histogram"),
    settings=(DARK_CURRENT, HOT_PIXELS),
    present=lambda view: dark_electrons(view) > 0.0 or view.camera[HOT_PIXELS] > 0.0,
    run=PointByPoint(work),
    cost=measured((3.45, 119)),
    skipped=skipped,
    knows_where=True,
    after=after,
    random=True,
    needs="shutter",
)
