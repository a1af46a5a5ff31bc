"""Layers that are moved or resampled, and what an error in one of them can show.

A stack shows an error of its layers as at most the sum over layers of the colour's error plus half
the range times the cover's; `LayerFacts` hold steps weighted in exactly that way.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.body import VELOCITY
from quizgen.camera.draw import Layer, Motion, Sheet, sheets
from quizgen.camera.facts import Error, Facts, LayerFacts
from quizgen.camera.filters import sample
from quizgen.camera.scene import Image
from quizgen.camera.view import View

Field = NDArray[np.float64]


def resampled(layer: Layer, work: Callable[[Image], Image]) -> Layer:
    """A layer whose colour and cover went the same way."""
    cover = None if layer.cover is None else work(layer.cover)
    return replace(layer, colour=work(layer.colour), cover=cover)


def each(facts: Facts, view: View) -> Iterator[tuple[LayerFacts, Sheet, float]]:
    """Facts and sheet of every layer, and the most that a layer's error can show."""
    for layer, sheet in zip(facts.layers, sheets(view), strict=True):
        yield layer, sheet, facts.span * (1.0 if sheet.opaque else 1.5)


def within(amount: float, facts: Facts) -> Error:
    """Every picture made by averaging stays inside the range."""
    return Error(min(amount, facts.span))


def rounding(view: View) -> float:
    """How far positions in single precision may lie beside what they should be, px."""
    return float(np.spacing(np.float32(max(view.width, view.height))))


def shifted(facts: Facts, distance: float, view: View) -> Error:
    """Error of reading every layer a distance away, px: distance times the steepest slope."""
    far = distance + rounding(view)
    return within(sum(far * math.hypot(*layer.jump) for layer in facts.layers), facts)


def mixed_axes(facts: Facts, factor: float) -> Facts:
    """Every layer magnified or turned: steps along any direction, times a factor."""
    layers = []
    for layer in facts.layers:
        step = factor * math.hypot(*layer.jump)
        layers.append(LayerFacts((step, step), (2 * step, 2 * step)))
    return replace(facts, layers=tuple(layers))


# Movement


def anything_moves(view: View) -> bool:
    """Whether the camera or a thing moves over the picture."""
    pan = view.camera[VELOCITY]
    return any(pan) or any(
        thing.spin or any(part.value for part in thing.velocity) for thing in view.scene.things
    )


def path(motion: Motion, view: View, time: float) -> tuple[float, float]:
    """Movement of a layer over the sensor in a time, px, the camera's own included."""
    own, all_ = motion.velocity, view.camera[VELOCITY]
    return (own[0] + all_[0]) * time, (own[1] + all_[1]) * time


def rim(motion: Motion, view: View) -> float:
    """Distance from the pivot to the farthest corner, px: blur may have spread a layer so far."""
    x, y = motion.pivot
    return math.hypot(max(x, view.width - 1 - x), max(y, view.height - 1 - y))


def chord(motion: Motion, view: View, time: float) -> float:
    """Farthest any point of a turning layer gets from where it is at time 0, px."""
    if not motion.spin:
        return 0.0
    turn = math.sin(min(abs(motion.spin) * time / 2.0, math.pi / 2.0))
    return 2.0 * rim(motion, view) * turn + rounding(view)


def turned(image: Image, view: View, motion: Motion, angle: float | Field) -> Image:
    """Rotate a layer about its pivot; an angle per row for the rolling shutter."""
    x = np.arange(view.width)[None, :] - motion.pivot[0]
    y = np.arange(view.height)[:, None] - motion.pivot[1]
    cosine, sine = np.cos(angle), np.sin(angle)
    column = cosine * x + sine * y + motion.pivot[0]
    row = cosine * y - sine * x + motion.pivot[1]
    return sample(image, column.astype(np.float32), row.astype(np.float32))
