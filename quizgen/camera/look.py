"""What is known of a picture before its effects: from its colours, a glimpse, or all of it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from msgspec.structs import replace

from quizgen.camera.draw import Layer, Sheet, Stack, sheets
from quizgen.camera.facts import Facts, LayerFacts
from quizgen.camera.scene import Image
from quizgen.camera.uneven import extent, steps, wider
from quizgen.camera.view import View

_ROWS = 64
_BESIDE = 4


def _guess(sheet: Sheet, middle: float, span: float) -> LayerFacts:
    """Steps a layer may have, from its colours: from nothing to any of them, plus the cover's."""
    jump = span if sheet.opaque else _colour_step(sheet, middle) + span / 2
    return LayerFacts((jump, jump), (2 * jump, 2 * jump))


def _colour_step(sheet: Sheet, middle: float) -> float:
    textured = [thing.other for thing in sheet.things if thing.texture != "plain"]
    colours = [*textured, *(thing.colour for thing in sheet.things)]
    levels = [0.0, *(level - middle for colour in colours for level in colour)]
    return max(levels) - min(levels)


def coarse(view: View) -> Facts:
    """Facts from the colours alone, without drawing or reading a pixel."""
    low, high = view.scene.range
    middle, span = (low + high) / 2, high - low
    return Facts(low, high, tuple(_guess(sheet, middle, span) for sheet in sheets(view)))


def measured(stack: Stack, view: View) -> Facts:
    """Facts from one pass over all of the drawn layers that is not even."""
    low, high = view.scene.range
    return Facts(
        low, high, tuple(_measured(layer, (low + high) / 2, high - low) for layer in stack)
    )


def _measured(layer: Layer, middle: float, span: float) -> LayerFacts:
    found = [_measure(part, middle, span, 1, ends=ends) for part, ends in _uneven_parts(layer)]
    pairs = [[*one.jump, *one.bend] for one in found] or [[0.0] * 4]
    across, down, bend_across, bend_down = (max(column) for column in zip(*pairs, strict=True))
    return LayerFacts((across, down), (bend_across, bend_down))


def _uneven_parts(layer: Layer) -> Iterator[tuple[Layer, tuple[Ends, Ends]]]:
    """Parts of a layer outside of which it has no steps, and where they end at its border."""
    for box in steps(layer):
        cover = None if layer.cover is None else layer.cover[box]
        sides = zip(box, layer.colour.shape, strict=False)
        rows, columns = ((part.start == 0, part.stop == side) for part, side in sides)
        yield replace(layer, colour=layer.colour[box], cover=cover), (rows, columns)


Ends = tuple[bool, bool]
"""Whether the first and the last line stand at the border, where a picture is mirrored."""
_ALL = (True, True), (True, True)


def filled(stack: Stack) -> Stack:
    """The part of each layer that is not empty, with two empty lines around: no step is lost."""
    return tuple(_filled(layer) for layer in stack)


def _filled(layer: Layer) -> Layer:
    if layer.cover is None:
        return layer
    box = wider(extent(layer), (2, 2), layer.colour.shape)
    return replace(layer, colour=layer.colour[box], cover=layer.cover[box])


def glimpsed(stack: Stack, view: View, every: int, *, columns: bool = True) -> Facts:
    """Facts of every n-th row and column only: never above the true ones, so a hint, no bound."""
    low, high = view.scene.range
    middle, span = (low + high) / 2, high - low
    seen = (_measure(layer, middle, span, every, columns=columns) for layer in stack)
    return Facts(low, high, tuple(seen))


def _measure(
    layer: Layer,
    middle: float,
    span: float,
    every: int,
    *,
    columns: bool = True,
    ends: tuple[Ends, Ends] = _ALL,
) -> LayerFacts:
    levels = middle, span
    along_x = _differences(layer, levels, every, 1, ends[1])
    along_y = _differences(layer, levels, every, 0, ends[0]) if columns else (0.0, 0.0)
    return LayerFacts((along_x[0], along_y[0]), (along_x[1], along_y[1]))


def _differences(
    layer: Layer, levels: tuple[float, float], every: int, axis: int, ends: Ends
) -> tuple[float, float]:
    step, bend, (middle, span) = 0.0, 0.0, levels
    for part, covered in _parts(layer.colour, layer.cover, every, axis):
        if covered is None:
            first, second = _extremes(part, axis, ends)
        else:
            edge = _extremes(covered, axis, ends)
            first, second = _extremes(_against(part, covered, middle), axis, ends)
            first, second = first + edge[0] * span / 2, second + edge[1] * span / 2
        step, bend = max(step, first), max(bend, second)
    slack = 1.0 + 1e-6
    return step * slack, bend * slack


def _against(colour: Image, cover: Image, middle: float) -> Image:
    """Colour by how much it differs from what stands behind it."""
    result = np.empty_like(colour)
    for channel in range(colour.shape[2]):  # far faster than NumPy's loops over three values
        one = np.multiply(cover[..., 0], float(middle), out=result[..., channel])
        np.subtract(colour[..., channel], one, out=one)
    return result


def _parts(
    colour: Image, cover: Image | None, every: int, axis: int
) -> Iterator[tuple[Image, Image | None]]:
    """Bands across the axis, or lines along it thinned out to every n-th."""
    lines = colour.shape[1 - axis]
    if every > 1 and axis == 0 and lines >= every * _BESIDE:
        lines -= lines % (every * _BESIDE)
    wide = _ROWS * every
    for start in range(0, lines, wide):
        band = slice(start, min(start + wide, lines))
        part = (band, slice(None)) if axis == 1 else (slice(None), band)
        yield (
            _thinned(colour[part], every, axis),
            None if cover is None else _thinned(cover[part], every, axis),
        )


def _thinned(values: Image, every: int, axis: int) -> Image:
    """Every n-th row; of columns some beside each other, which are read together."""
    height, width, channels = values.shape
    apart = every * _BESIDE
    if every == 1 or axis == 1:
        return values[::every]
    if width < apart:
        return values[:, ::every]
    groups = values.reshape(height, -1, apart, channels)
    return groups[:, :, :_BESIDE].reshape(height, -1, channels)


def _extremes(values: Image, axis: int, ends: Ends) -> tuple[float, float]:
    """Largest first and second difference along an axis; at the border mirrored."""
    if values.shape[axis] < 2:
        return 0.0, 0.0
    found = _steps(values, axis)
    first = _largest(found)
    lines = found if axis == 0 else found.swapaxes(0, 1)
    mirrored = [lines[at] for at, there in zip((0, -1), ends, strict=True) if there]
    second = max([2.0 * _largest(line) for line in mirrored], default=0.0)
    return first, max(second, _largest(_steps(found, axis))) if len(lines) > 1 else second


def _steps(values: Image, axis: int) -> Image:
    """Differences of neighbours; NumPy's own takes as long again to find out what is asked."""
    return values[1:] - values[:-1] if axis == 0 else values[:, 1:] - values[:, :-1]


def _largest(values: Image) -> float:
    return float(max(values.max(), -values.min()))
