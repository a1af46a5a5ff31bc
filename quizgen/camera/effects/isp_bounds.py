"""How much raw development and edits can matter, from facts alone."""

# ruff: noqa: ARG001 - every effect and every bound takes the same arguments

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from quizgen.camera.effects.sensor_bounds import corner_light, steepest_fall_off
from quizgen.camera.facts import DEVIATIONS, Error, Facts
from quizgen.camera.power import TABLE, encode_number
from quizgen.camera.scene import View

# Raw development


CURVE_ERROR = 1e-6
"""Absolute error of computed tone curves and hues."""


def flat_gain(view: View) -> tuple[float, float]:
    """Smallest and largest factor of the flat-field correction."""
    corner = corner_light(view)
    return corner, 1.0 / corner


def flat_skipped(facts: Facts, view: View) -> Error:
    """The mean lies between corner and centre, so factors lie between V and 1/V of the corner."""
    return Error(facts.size * (flat_gain(view)[1] - 1.0), facts.noise * (flat_gain(view)[1] - 1.0))


def flat_carried(error: Error, facts: Facts, view: View) -> Error:
    """Amplified most at the corner."""
    return error.times(flat_gain(view)[1])


def flat_after(facts: Facts, view: View) -> Facts:
    """Brighter, and steeper where the fall-off is divided out."""
    gain = flat_gain(view)[1]
    grown = facts.scaled(gain)
    step = (facts.size + facts.reach) * gain * gain * steepest_fall_off(view)
    low = min(facts.low * flat_gain(view)[0], grown.low)
    return replace(grown.with_jump((grown.jump[0] + step, grown.jump[1] + step)), low=low)


def balance_skipped(facts: Facts, view: View) -> Error:
    """Largest value times the gain farthest from 1."""
    factor = max(abs(gain - 1.0) for gain in view.camera.white_balance)
    return Error(facts.size * factor, facts.noise * factor)


def balance_carried(error: Error, facts: Facts, view: View) -> Error:
    """Amplified by the largest gain."""
    return error.times(max(view.camera.white_balance))


def balance_after(facts: Facts, view: View) -> Facts:
    """Scaled by gains between the smallest and the largest."""
    gains = view.camera.white_balance
    grown = facts.scaled(max(gains))
    low = min(facts.low * min(gains), facts.low * max(gains))
    high = max(facts.high * min(gains), facts.high * max(gains))
    return replace(grown, low=low, high=high)


def encoded_gap(width: float, bottom: float, view: View) -> float:
    """Largest difference after encoding of values that differ by at most ``width``.

    Tone curves are concave, so the gap is largest at the dark end.
    """
    start = max(0.0, bottom)
    gamma = view.camera.gamma
    return encode_number(start + width, gamma) - encode_number(start, gamma)


def gamma_skipped(facts: Facts, view: View) -> Error:
    """Largest distance of the curve from the diagonal over the range, and what it clips."""
    low, high = max(0.0, min(facts.bottom, 1.0)), min(1.0, max(facts.top, 0.0))
    grid = np.linspace(low, high, 257)
    curve = np.array([encode_number(float(value), view.camera.gamma) for value in grid])
    # both curves rise, so between two points the gap is at most the later minus the earlier
    gap = float(max((curve[1:] - grid[:-1]).max(), curve[0] - low))
    return Error(gap + CURVE_ERROR + max(facts.top - 1.0, -facts.bottom, 0.0))


def gamma_table(facts: Facts, view: View) -> Error:
    """Half a step of the table, spread most at the dark end."""
    half = 0.5 / TABLE + 1e-7
    return Error(encoded_gap(half, facts.bottom - half, view))


def gamma_carried(error: Error, facts: Facts, view: View) -> Error:
    """The darkest values are spread most."""
    sure = encoded_gap(error.sure, facts.bottom - error.total, view)
    total = encoded_gap(error.total, facts.bottom - error.total, view)
    return Error(sure, max(0.0, total - sure) / DEVIATIONS)


def gamma_after(facts: Facts, view: View) -> Facts:
    """Encoded range; steps as far as the dark end spreads them."""
    gamma, bottom = view.camera.gamma, facts.bottom
    low, high = encode_number(facts.low, gamma), encode_number(facts.high, gamma)
    jump = (encoded_gap(facts.jump[0], bottom, view), encoded_gap(facts.jump[1], bottom, view))
    noise = encoded_gap(facts.reach, bottom, view) / DEVIATIONS
    return replace(Facts(low, high, facts.layers, noise).with_jump(jump))


# Edits


def hsv_skipped(facts: Facts, view: View) -> Error:
    """Hue stays between a pixel's channels, saturation and value scale them."""
    camera = view.camera
    clip = max(facts.top - 1.0, -facts.bottom, 0.0)
    top = min(max(facts.top, 0.0), 1.0)
    chroma = min(top, facts.span + 2 * facts.reach)
    turned = chroma if math.fmod(camera.hue, 2 * math.pi) else 0.0
    return Error(
        turned
        + abs(camera.saturation - 1.0) * chroma
        + abs(camera.value - 1.0) * top
        + clip
        + CURVE_ERROR
    )


def hsv_gain(view: View) -> float:
    """Bound on how much an edit spreads differences: every factor of a piecewise smooth map."""
    camera = view.camera
    turned = 3.0 if math.fmod(camera.hue, 2 * math.pi) else 1.0
    saturated = 1.0 if camera.saturation <= 1.0 else 3.0 * camera.saturation
    scaled = camera.value if camera.value <= 1.0 else 2.0 * camera.value
    return turned * saturated * scaled


def hsv_carried(error: Error, facts: Facts, view: View) -> Error:
    """Spread by at most `hsv_gain`."""
    return error.times(hsv_gain(view))


def hsv_after(facts: Facts, view: View) -> Facts:
    """Anything from black to the brightest value."""
    gain = hsv_gain(view)
    high = min(1.0, facts.top * max(1.0, view.camera.value))
    changed = Facts(0.0, high, facts.layers, min(facts.noise * gain, 1.0))
    return changed.with_jump((facts.jump[0] * gain, facts.jump[1] * gain))


def gaussian_skipped(facts: Facts, view: View) -> Error:
    """Its standard deviation, and what it clips."""
    return Error(max(facts.top - 1.0, -facts.bottom, 0.0), view.camera.gaussian_noise)


def gaussian_after(facts: Facts, view: View) -> Facts:
    """Noisier and clipped."""
    low, high = min(max(facts.low, 0.0), 1.0), max(0.0, min(facts.high, 1.0))
    noise = math.hypot(facts.noise, view.camera.gaussian_noise)
    noisy = replace(facts, noise=noise, low=low, high=high)
    return noisy.with_jump(facts.jump)


def impulse_skipped(facts: Facts, view: View) -> Error:
    """Any pixel may turn black or white."""
    return Error(math.inf)


def impulse_after(facts: Facts, view: View) -> Facts:
    """Steps of the whole range."""
    wide = replace(facts, low=min(facts.low, 0.0), high=max(facts.high, 1.0))
    return wide.with_jump((wide.span, wide.span))


def _range(view: View) -> tuple[float, float, float, float]:
    return view.camera.normalise or (0.0, 1.0, 0.0, 1.0)


def normalised(value: float, view: View) -> float:
    """`stretch_range` of one number."""
    low, high, new_low, new_high = _range(view)
    return new_low + (new_high - new_low) * min(max((value - low) / (high - low), 0.0), 1.0)


def normalise_skipped(facts: Facts, view: View) -> Error:
    """Largest at an end of the range or where clipping starts."""
    ends = (facts.bottom, facts.top, _range(view)[0], _range(view)[1])
    inside = [value for value in ends if facts.bottom <= value <= facts.top]
    return Error(max(abs(normalised(value, view) - value) for value in inside))


def normalise_slope(view: View) -> float:
    """Stretch factor."""
    low, high, new_low, new_high = _range(view)
    return abs(new_high - new_low) / (high - low)


def normalise_carried(error: Error, facts: Facts, view: View) -> Error:
    """Stretched."""
    return error.times(normalise_slope(view))


def normalise_after(facts: Facts, view: View) -> Facts:
    """Stretched and clipped."""
    ends = normalised(facts.low, view), normalised(facts.high, view)
    factor = normalise_slope(view)
    jump = facts.jump[0] * factor, facts.jump[1] * factor
    return Facts(min(ends), max(ends), facts.layers, facts.noise * factor).with_jump(jump)
