"""How much the effects of the sensor can matter, from facts alone."""

# ruff: noqa: ARG001 - every effect and every bound takes the same arguments

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from quizgen.camera.effects.sensor import dark_electrons, fall_off, levels
from quizgen.camera.facts import EXCEEDED, Error, Facts, LayerFacts
from quizgen.camera.scene import View

POISSON_GAP = 3.8
"""Electrons between the quantiles of Poisson and normal law, at any mean, for all but the share
`EXCEEDED` of the values: z^2/4 where the normal law turns negative, else (z^2 - 1)/6 for the
skewness and 1/2 for whole electrons."""


def _well(view: View) -> float:
    return view.camera.full_well or math.inf


# Light


def corner_light(view: View) -> float:
    """Share of light kept at the picture's corner."""
    return float(fall_off(view.corner, view))


def steepest_fall_off(view: View) -> float:
    """Largest change of the fall-off over one pixel.

    The fall-off only sinks with the radius, so differences over 1.25 px at steps of 0.25 px bound
    every difference over 1 px.
    """
    radii = np.arange(0.0, view.corner + 2.0, 0.25)
    kept = np.asarray(fall_off(np.minimum(radii, view.corner), view)) * np.ones_like(radii)
    return float((kept[:-5] - kept[5:]).max())


def vignetting_skipped(facts: Facts, view: View) -> Error:
    """The corner loses most: largest value times (1 - V)."""
    return Error(facts.size * (1.0 - corner_light(view)))


def vignetting_after(facts: Facts, view: View) -> Facts:
    """Darker, and steeper by the fall-off itself."""
    step = facts.size * steepest_fall_off(view)
    low = min(facts.low, facts.low * corner_light(view))
    jump = facts.jump[0] + step, facts.jump[1] + step
    return replace(facts.with_jump(jump), low=low)


def exposure_skipped(facts: Facts, view: View) -> Error:
    """Largest value times the missing factor."""
    return Error(facts.size * abs(2.0**view.camera.exposure - 1.0))


def exposure_carried(error: Error, facts: Facts, view: View) -> Error:
    """Errors are amplified too."""
    return error.times(2.0**view.camera.exposure)


def exposure_after(facts: Facts, view: View) -> Facts:
    """Everything times the factor."""
    return facts.scaled(2.0**view.camera.exposure)


# Noise


def _with_noise(facts: Facts, sigma: float) -> Facts:
    return replace(facts, noise=math.hypot(facts.noise, sigma))


def shot_sigma(facts: Facts, view: View) -> float:
    """Standard deviation at the brightest place: sqrt(N)/full well."""
    return math.sqrt(max(facts.high, 0.0) / _well(view))


def shot_skipped(facts: Facts, view: View) -> Error:
    """The noise of the brightest place."""
    return Error(0.0, shot_sigma(facts, view))


def shot_carried(error: Error, facts: Facts, view: View) -> Error:
    """Another signal has another noise, and may make one electron more.

    The root is steepest at the darkest place; a change of the mean by less than `EXCEEDED`
    electrons changes fewer counts than that share.
    """
    well, start = _well(view), max(0.0, facts.bottom - error.total)
    apart = math.sqrt(start + error.total) - math.sqrt(start)
    electron = 1.0 / well if error.total * well > EXCEEDED else 0.0
    return Error(error.sure + electron, error.sigma + apart / math.sqrt(well))


def shot_gaussian(facts: Facts, view: View) -> Error:
    """Distance of the two laws' quantiles."""
    return Error(POISSON_GAP / _well(view))


def shot_after(facts: Facts, view: View) -> Facts:
    """Noisier; never below zero electrons."""
    return _with_noise(facts, shot_sigma(facts, view))


def _dark(view: View) -> Error:
    electrons, well = dark_electrons(view), _well(view)
    gap = POISSON_GAP / well if electrons else 0.0
    return Error(electrons / well + gap, math.sqrt(electrons) / well)


def dark_skipped(facts: Facts, view: View) -> Error:
    """Mean charge and its noise; a hot pixel may be anywhere."""
    if view.camera.hot_pixels:
        return Error(math.inf)
    return _dark(view)


def dark_after(facts: Facts, view: View) -> Facts:
    """Brighter and noisier; hot pixels are steps of the whole range."""
    mean = dark_electrons(view) / _well(view)
    lifted = _with_noise(replace(facts, high=facts.high + mean), _dark(view).sigma)
    if not view.camera.hot_pixels:
        return lifted
    lifted = replace(lifted, high=max(lifted.high, 1.0))
    return lifted.with_jump((lifted.span, lifted.span))


def read_skipped(facts: Facts, view: View) -> Error:
    """Its standard deviation."""
    return Error(0.0, view.camera.read_noise / _well(view))


def read_after(facts: Facts, view: View) -> Facts:
    """Noisier."""
    return _with_noise(facts, view.camera.read_noise / _well(view))


# Too much light


def _overflows(facts: Facts, error: float = 0.0) -> bool:
    return facts.top + error > 1.0


def blooming_skipped(facts: Facts, view: View) -> Error:
    """Nothing below the full well; else a filled column."""
    if not _overflows(facts):
        return Error()
    return Error(max(facts.top - 1.0, 1.0 - facts.bottom))


def blooming_carried(error: Error, facts: Facts, view: View) -> Error:
    """Spilt charge adds up along a column."""
    if not _overflows(facts, error.total):
        return error
    return Error(min((view.height + 1) * error.total, 1.0 - min(facts.bottom - error.total, 0.0)))


def blooming_after(facts: Facts, view: View) -> Facts:
    """A filled column is a step of the whole range."""
    if not _overflows(facts):
        return facts
    full = replace(facts, high=1.0)
    return full.with_jump((full.span + full.reach, full.span + full.reach))


def smear_skipped(facts: Facts, view: View) -> Error:
    """Share of the brightest possible column."""
    return Error(view.camera.smear * facts.size)


def smear_carried(error: Error, facts: Facts, view: View) -> Error:
    """The column's mean carries the error again."""
    return error.times(1.0 + view.camera.smear)


def smear_after(facts: Facts, view: View) -> Facts:
    """Brighter; steps between columns grow."""
    return facts.scaled(1.0 + view.camera.smear)


def full_well_skipped(facts: Facts, view: View) -> Error:
    """What would stand above the full well."""
    return Error(max(0.0, facts.top - 1.0))


def full_well_after(facts: Facts, view: View) -> Facts:
    """No more than 1; clipping may bend."""
    capped = replace(facts, high=min(facts.high, 1.0), low=min(facts.low, 1.0))
    return capped.with_jump(facts.jump) if _overflows(facts) else capped


# Mosaic and converter


def nothing_yet(facts: Facts, view: View) -> Error:
    """What the mosaic loses shows after demosaicing."""
    return Error()


def demosaic_skipped(facts: Facts, view: View) -> Error:
    """Means of two or four neighbours miss by half the bends; noise is averaged differently."""
    bend, jump = facts.bend, facts.jump
    missed = min((bend[0] + bend[1]) / 2.0, jump[0] + jump[1], facts.span)
    return Error(missed, math.sqrt(1.5) * facts.noise)


def demosaic_after(facts: Facts, view: View) -> Facts:
    """Green sites stand beside means of four."""
    x, y = facts.jump
    return facts.with_jump((x + y / 2, y + x / 2))


def quantise_step(view: View) -> float:
    """One code, 1 = full scale."""
    return 1.0 / levels(view.camera.bit_depth or 16)


def quantise_skipped(facts: Facts, view: View) -> Error:
    """Half a code, and what the converter would clip."""
    clipped = max(facts.top - 1.0, 0.0 - facts.bottom, 0.0)
    return Error(quantise_step(view) / 2.0 + clipped)


def quantise_carried(error: Error, facts: Facts, view: View) -> Error:
    """Any difference may become a whole code."""
    step = quantise_step(view)
    if error.sigma:
        return Error(error.sure + step, error.sigma)
    return Error(math.ceil(error.sure / step - 1e-9) * step)


def quantise_after(facts: Facts, view: View) -> Facts:
    """Clipped; steps grow by up to a code, bends by two."""
    step = quantise_step(view)
    clipped = facts.top > 1.0 or facts.bottom < 0.0
    jump = facts.jump[0] + step, facts.jump[1] + step
    bend = facts.bend[0] + 2 * step, facts.bend[1] + 2 * step
    low = min(max(facts.low - step / 2, 0.0), 1.0)
    high = max(min(facts.high + step / 2, 1.0), 0.0)
    if clipped:
        return Facts(low, high, (LayerFacts(jump, (2 * jump[0], 2 * jump[1])),), facts.noise)
    return Facts(low, high, (LayerFacts(jump, bend),), facts.noise)
