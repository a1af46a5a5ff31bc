"""Layers that are moved or resampled, and what an error in one of them can show.

A stack shows an error of its layers as at most the sum over layers of the colour's error plus half
the range times the cover's; `LayerFacts` hold steps weighted in exactly that way.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from quizgen.camera.body import VELOCITY
from quizgen.camera.draw import Box, Layer, Motion, Sheet, content, leaves_frame, sheets
from quizgen.camera.facts import Error, Facts, LayerFacts
from quizgen.camera.filters import convolve, sample
from quizgen.camera.kernels import Kernel
from quizgen.camera.scene import Image
from quizgen.camera.view import View

Field = NDArray[np.float64]


def resampled(layer: Layer, work: Callable[[Image, Box], Image], reach: float) -> Layer:
    """A layer whose colour and cover went the same way.

    Parameters
    ----------
    layer : Layer
    work : callable
        Gets an image and which part of the result is wanted.
    reach : float
        How far anything may get, px: beyond it an empty place stays empty, so that only what is
        near the content is computed.
    """
    box = _reached(layer, reach)
    if layer.cover is None:
        return replace(layer, colour=work(layer.colour, box))
    if not box[0].stop:
        return layer
    return _within_box(layer, box, work(layer.colour, box), work(layer.cover, box))


def blurred(layer: Layer, kernel: Kernel) -> Layer:
    """A layer convolved with a kernel; colour and cover go through it together."""
    if kernel.size == 1:
        return layer
    if layer.cover is None:
        return replace(layer, colour=convolve(layer.colour, kernel))
    reach = max(kernel.shape) // 2
    rows, columns = _reached(layer, reach)
    # unlike zeros_like, zeros takes no memory where nothing is written
    colour: Image = np.zeros(layer.colour.shape, layer.colour.dtype)
    cover: Image = np.zeros(layer.cover.shape, layer.cover.dtype)
    band = max(_BAND, 64 * reach)
    for start in range(rows.start, rows.stop, band):
        stop, first = min(start + band, rows.stop), max(start - reach, 0)
        seen = slice(first, stop + reach), columns
        both = convolve(np.concatenate([layer.colour[seen], layer.cover[seen]], axis=2), kernel)
        inner, part = both[start - first :][: stop - start], (slice(start, stop), columns)
        colour[part], cover[part] = inner[..., : colour.shape[2]], inner[..., colour.shape[2] :]
    return replace(layer, colour=colour, cover=cover)


_BAND = 256
"""Rows blurred at once, so that copies stay small."""


def _within_box(layer: Layer, box: Box, colour: Image, cover: Image) -> Layer:
    """A layer that is empty but for a box."""
    parts = []
    for part in (colour, cover):
        parts.append(np.zeros((*layer.colour.shape[:2], part.shape[2]), part.dtype))
        parts[-1][box] = part
    return replace(layer, colour=parts[0], cover=parts[1])


def _reached(layer: Layer, reach: float) -> Box:
    """Where anything of a layer may get."""
    shape = layer.colour.shape
    if layer.cover is None:
        return slice(0, shape[0]), slice(0, shape[1])
    return wider(content(layer.cover), math.ceil(min(reach, sum(shape))) + 1, shape)


def wider(box: Box, far: int, shape: tuple[int, ...]) -> Box:
    """A box, unless it is empty, with so much more on each side as there is."""
    if not box[0].stop:
        return box
    rows, columns = (
        slice(max(part.start - far, 0), min(part.stop + far, length))
        for part, length in zip(box, shape, strict=False)
    )
    return rows, columns


def each(facts: Facts, view: View) -> Iterator[tuple[LayerFacts, Sheet, float]]:
    """Facts and sheet of every layer, and the most that a layer's error can show."""
    for layer, sheet in zip(facts.layers, sheets(view), strict=True):
        yield layer, sheet, facts.span * (1.0 if sheet.opaque else 1.5)


def farthest(view: View, reach: Callable[[Sheet], tuple[float, float]]) -> tuple[float, float]:
    """How far outside (across, down) any sheet is looked at; what is even there needs no margin."""
    reaches = [reach(sheet) for sheet in sheets(view) if leaves_frame(sheet, view)]
    across, down = zip((0.0, 0.0), *reaches, strict=True)
    return max(across), max(down)


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


def turned(layer: Layer, angles: Sequence[float | Field], reach: float) -> Layer:
    """Mean of a layer rotated about its pivot; an angle per row for the rolling shutter.

    Parameters
    ----------
    layer : Layer
    angles : sequence
        Of numbers, or arrays of shape (H, 1).
    reach : float
        Farthest that anything gets by these angles, px.
    """
    images = [layer.colour] if layer.cover is None else [layer.colour, layer.cover]
    results = [np.zeros(image.shape, image.dtype) for image in images]
    for tile in _filled(layer, reach):
        for result, mean in zip(results, _turned(images, tile, layer.motion, angles), strict=True):
            result[tile] = mean
    return replace(layer, colour=results[0], cover=None if layer.cover is None else results[1])


_TILE, _CELL = 128, 32
"""Sides of the squares that are turned or not, and of those that are empty or not."""
_ROW = 8
"""Squares beside each other that are turned at once: few calls, and all that they need is small."""


def _filled(layer: Layer, reach: float) -> Iterator[Box]:
    """Rows of tiles that content may reach."""
    height, width = layer.colour.shape[:2]
    lines = [np.arange(0, length, _CELL) for length in (height, width)]
    there = np.ones((len(lines[0]), len(lines[1])), bool)
    if layer.cover is not None:
        rows = np.logical_or.reduceat(layer.cover.any(axis=2), lines[0], axis=0)
        there = np.logical_or.reduceat(rows, lines[1], axis=1)
    far, cells = math.ceil(min(reach, height + width) / _CELL), _TILE // _CELL
    for y in range(0, len(there), cells):
        band = np.any(there[max(0, y - far) : y + cells + far], axis=0)
        starts = range(0, len(band), cells)
        full = [bool(np.any(band[max(0, x - far) : x + cells + far])) for x in starts]
        for first, last in _runs(full):
            yield slice(y * _CELL, y * _CELL + _TILE), slice(first * _TILE, last * _TILE)


def _runs(full: list[bool]) -> Iterator[tuple[int, int]]:
    """First and last (exclusive) of full places beside each other, a few at a time."""
    first = 0
    for place, now in enumerate([*full, False]):
        if not now or place - first == _ROW:
            if first < place:
                yield first, place
            first = place + (not now)


def _turned(
    images: list[Image], tile: Box, motion: Motion, angles: Sequence[float | Field]
) -> list[Image]:
    height, width = images[0].shape[:2]
    x = np.arange(width)[None, tile[1]] - motion.pivot[0]
    y = np.arange(height)[tile[0], None] - motion.pivot[1]
    totals = [np.zeros((y.size, x.size, image.shape[2]), image.dtype) for image in images]
    for angle in angles:
        by_row = angle if isinstance(angle, float) else angle[tile[0]]
        cosine, sine = np.cos(by_row), np.sin(by_row)
        column = (cosine * x + sine * y + motion.pivot[0]).astype(images[0].dtype)
        row = (cosine * y - sine * x + motion.pivot[1]).astype(images[0].dtype)
        for place, image in enumerate(images):
            totals[place] += sample(image, column, row)
    return [total * (1.0 / len(angles)) for total in totals]
