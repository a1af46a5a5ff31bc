"""Shot noise: electrons arrive at random."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.body import FULL_WELL
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint, Rung
from quizgen.camera.facts import ODD, REACH, Error, Facts
from quizgen.camera.noise import MANY, POISSON_GAP, electrons_at_white, luck, noisier, poisson_gap
from quizgen.camera.poisson import poisson_quantiles
from quizgen.camera.scene import Image
from quizgen.camera.settings import Setting
from quizgen.camera.values import truth
from quizgen.camera.view import View

SHOT_NOISE = Setting("shot_noise", truth, True)
"""Needs a full well; without one no electrons are counted."""


def work(view: View, rung: str = "") -> Work:
    """Electrons arrive at random: Poisson with mean (signal times full well).

    The rung ``gaussian`` uses the normal law with the same mean and variance (errata E23).
    """
    source, well = luck(view, "shot noise"), electrons_at_white(view)
    to_electrons, to_signal = float(well), 1.0 / well

    def counted(part: Image, tile: Tile) -> None:
        np.clip(part, 0.0, math.inf, out=part)
        part *= to_electrons
        counts = poisson_quantiles(part, source.normal(tile.number, part.size, part.dtype))
        np.multiply(counts, to_signal, out=part)

    def spread(part: Image, tile: Tile) -> None:
        np.clip(part, 0.0, math.inf, out=part)
        noise = np.sqrt(part * to_signal)
        noise *= source.normal(tile.number, part.size, part.dtype)
        part += noise

    return spread if rung == "gaussian" else counted


def skipped(facts: Facts, view: View) -> Error:
    """The noise of N electrons, sqrt(N)/full well, and by how much counts exceed it."""
    well, brightest = electrons_at_white(view), max(facts.high, 0.0)
    gap, noise = poisson_gap(brightest * well) / well, math.sqrt(brightest / well)
    return Error(gap, noise, root=1.0 / math.sqrt(well) if brightest * well >= MANY else 0.0)


def carried(error: Error, facts: Facts, view: View) -> Error:
    """Another signal has another noise, and may make one electron more.

    A change of the mean by a small part of an electron changes no more than this share of the
    counts. The root is steepest at the darkest place. Beside it and whole electrons, the skewness
    of the law changes by 1.6/N^(3/2) per electron of the mean, up to 6 standard deviations.
    """
    well, most = electrons_at_white(view), error.certain
    start = 0.0 if facts.bottom < most else facts.bottom - most
    apart = math.sqrt(start + most) - math.sqrt(start)
    noisy = error.wider(apart / math.sqrt(well))
    if most * well <= ODD:
        return noisy.plus(Error(odd=most * well))
    dark = max(start * well, 1e-9)
    electrons = min(POISSON_GAP, 1.0 + 1.6 * most * well / dark**1.5)
    return noisy.more(electrons / well)


def gaussian(facts: Facts, view: View) -> Error:
    """Distance of the two laws' quantiles."""
    return Error(POISSON_GAP / electrons_at_white(view))


def after(facts: Facts, view: View) -> Facts:
    """Noisier; never below zero electrons."""
    noisy = noisier(facts, skipped(facts, view), _dip(facts.low, electrons_at_white(view)))
    return noisy.between(0.0, math.inf)


def _dip(low: float, well: float) -> tuple[float, float]:
    """How far counts are carried below the darkest place, by those of every brighter one.

    The mean less up to z = `REACH` roots of it grows from z^2/4 electrons on, where it is lowest.
    Counts are skew: no quantile lies as far as one electron below what the normal law says.
    """
    electrons, lowest = max(low, 0.0) * well, REACH**2 / 4.0
    root = math.sqrt(electrons) if electrons > lowest else (electrons + lowest) / REACH
    return 1.0 / well, root / well


EFFECT = Effect(
    name="shot noise",
    stage="sensor",
    decides=("shot noise", "noise", "snr", "histogram"),
    settings=(SHOT_NOISE,),
    present=lambda view: view.camera[FULL_WELL] is not None and view.camera[SHOT_NOISE],
    run=PointByPoint(work),
    cost=measured((6.68, 271), gaussian=(3.8, 159)),
    skipped=skipped,
    carried=carried,
    after=after,
    rungs=(Rung("gaussian", gaussian),),
    random=True,
)
