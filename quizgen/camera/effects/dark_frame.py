"""Dark frame: pedestal, fixed pattern and mean dark charge subtracted from the raw data."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.effect import Effect, on_composite
from quizgen.camera.effects import fixed_pattern, mosaic
from quizgen.camera.effects.dark_current import dark_electrons
from quizgen.camera.effects.gain import gain_factor
from quizgen.camera.effects.read_noise import READ_NOISE
from quizgen.camera.pixels.noise import (
    FARTHEST,
    add_normal_noise,
    effect_random,
    electrons_at_white,
)
from quizgen.camera.pixels.tiles import apply_tilewise, multiply_by
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import NEEDS_FULL_WELL, Setting, in_range
from quizgen.camera.setup.value_parsers import parse_integer
from quizgen.camera.setup.view import Signal, View

DARK_FRAMES = Setting("dark_frames", parse_integer, 0, (NEEDS_FULL_WELL, in_range(0, 10**6)))
"""Pictures with the lens covered, whose mean is subtracted; 0 subtracts nothing."""


def _frame_mean(view: View) -> float:
    """Return the expected value of a dark frame, pedestal plus mean dark charge, 1 = white."""
    dark = dark_electrons(view) / electrons_at_white(view)
    return (fixed_pattern.pedestal(view) + dark) * gain_factor(view)


def _remaining_noise(view: View) -> float:
    """Return the standard deviation left in the mean of the dark frames, 1 = white.

    It is that of one frame over the root of their number. A mean of counts is taken as normal; with
    one frame of few electrons it is not quite.
    """
    variance = view.camera[READ_NOISE] ** 2 + dark_electrons(view)
    frames = view.camera[DARK_FRAMES]
    return math.sqrt(variance / frames) / electrons_at_white(view) * gain_factor(view)


def master_dark(shape: tuple[int, ...], view: View) -> Image:
    """Return the mean of the camera's dark frames, shape (H, W, 3), 1 = white."""
    dark = dark_electrons(view) / electrons_at_white(view)
    left = add_normal_noise(_remaining_noise(view), effect_random(view, "dark frame"))
    works = [fixed_pattern.operation(view), multiply_by(gain_factor(view)), left]
    even = np.full((*shape[:2], 3), dark, view.precision)
    return apply_tilewise(even, works, into=even)[0]


def run(image: Image, view: View) -> Image:
    """Return the picture minus the mean of the dark frames."""
    dark = master_dark(image.shape, view)
    return image - (mosaic.run(dark, view) if image.shape[2] == 1 else dark)


def _largest_deviation(view: View) -> float:
    """Return how far a pixel of the mean frame can be from its expected value, 1 = white."""
    return fixed_pattern.farthest(view) * gain_factor(view) + FARTHEST * _remaining_noise(view)


def range_after(signal: Signal, view: View) -> Signal:
    """Return the range, darker by the mean frame and wider by the noise left in it."""
    far, mean = _largest_deviation(view), _frame_mean(view)
    return signal.with_margins(far + mean, far - mean)


EFFECT = Effect(
    name="dark frame",
    answers=("dark frame",),
    settings=(DARK_FRAMES,),
    is_present=lambda view: view.camera[DARK_FRAMES] > 0,
    run=on_composite(run),
    omission_bound=lambda _, view: _frame_mean(view) + _largest_deviation(view),
    range_after=range_after,
    needs_effects=("fixed pattern", "dark current"),
)
