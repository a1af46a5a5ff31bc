"""Shot noise: electrons arrive at random."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, PointByPoint
from quizgen.camera.pixels.noise import (
    FARTHEST,
    effect_random,
    electrons_at_white,
    farthest_count,
    poisson_quantiles,
)
from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import FULL_WELL, Setting
from quizgen.camera.setup.value_parsers import parse_bool
from quizgen.camera.setup.view import Signal, View

SHOT_NOISE = Setting("shot_noise", parse_bool, True)
"""Needs a full well; without one no electrons are counted."""


def operation(view: View) -> TileOperation:
    """Return what replaces a tile by Poisson counts of its electrons (signal times full well)."""
    source, well = effect_random(view, "shot noise"), electrons_at_white(view)
    to_electrons, to_signal = float(well), 1.0 / well

    def count_photons(part: Image, tile: Tile) -> None:
        """Draw the counts of a tile in place."""
        np.clip(part, 0.0, math.inf, out=part)
        part *= to_electrons
        counts = poisson_quantiles(
            part, source.draw_normal(tile.number, part.size, part.dtype, fine=True)
        )
        np.multiply(counts, to_signal, out=part)

    return count_photons


def omission_bound(signal: Signal, view: View) -> float:
    """Return how far a count can be from its mean; below black no electrons are counted."""
    well, brightest = electrons_at_white(view), max(signal.high, 0.0)
    return farthest_count(brightest * well) / well + max(-signal.low, 0.0)


def carry_error(error: float, signal: Signal, view: View) -> float:
    """Return the error after counting: another signal has another noise, and one electron more.

    The root is steepest at the darkest place. Apart from that and from whole electrons, the
    skewness of the law changes: z^2/4 electrons where the normal law turns negative, less where
    there are more.
    """
    well, start = electrons_at_white(view), max(signal.low - error, 0.0)
    apart = math.sqrt(start + error) - math.sqrt(start)
    dark = max(start * well, 1e-9)
    electrons = min(FARTHEST**2 / 4.0 + 2.0, 2.0 + 6.0 * error * well / dark**1.5)
    return error + FARTHEST * apart / math.sqrt(well) + electrons / well


def range_after(signal: Signal, view: View) -> Signal:
    """Return the range, wider by the noise and never below zero electrons."""
    far, light = omission_bound(signal, view), max(signal.low, 0.0)
    lowest = light - FARTHEST * math.sqrt(light / electrons_at_white(view))
    return Signal(
        max(lowest, 0.0) if light > _MANY / electrons_at_white(view) else 0.0, signal.high + far
    )


_MANY = FARTHEST**2
"""Electrons from which on counts are lowest where their mean is."""


EFFECT = Effect(
    name="shot noise",
    answers=("shot noise", "noise", "snr", "histogram"),
    settings=(SHOT_NOISE,),
    is_present=lambda view: view.camera[FULL_WELL] is not None and view.camera[SHOT_NOISE],
    run=PointByPoint(operation),
    omission_bound=omission_bound,
    carry_error=carry_error,
    range_after=range_after,
    size=EffectSize(
        lambda view: math.sqrt(max(view.scene.radiance_range[1], 0.0) * electrons_at_white(view)),
        "spread counts by up to {:.3g} electrons",
    ),
    speckles=True,
)
