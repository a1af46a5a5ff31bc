"""What is known of a picture before its effects: from its colours, a glimpse, or all of it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from msgspec.structs import replace

from quizgen.camera.draw import Layer, Sheet, Stack, content, sheets
from quizgen.camera.facts import Facts, LayerFacts
from quizgen.camera.scene import Image
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
    """Facts from one pass over the drawn layers, or over what of them is `filled`."""
    low, high = view.scene.range
    middle = (low + high) / 2
    return Facts(low, high, tuple(_measure(layer, middle, high - low, 1) for layer in stack))


def filled(stack: Stack) -> Stack:
    """The part of each layer that is not empty, with two empty lines around: no step is lost."""
    return tuple(_filled(layer) for layer in stack)


def _filled(layer: Layer) -> Layer:
    if layer.cover is None:
        return layer
    rows, columns = content(layer.cover)
    box = _with_margin(rows), _with_margin(columns)
    return replace(layer, colour=layer.colour[box], cover=layer.cover[box])


def _with_margin(part: slice) -> slice:
    return slice(max(part.start - 2, 0), max(part.stop + 2, 3))


def glimpsed(stack: Stack, view: View, every: int, *, columns: bool = True) -> Facts:
    """Facts of every n-th row and column only: never above the true ones, so a hint, no bound."""
    low, high = view.scene.range
    middle, span = (low + high) / 2, high - low
    seen = (_measure(layer, middle, span, every, columns=columns) for layer in stack)
    return Facts(low, high, tuple(seen))


def _measure(
    layer: Layer, middle: float, span: float, every: int, *, columns: bool = True
) -> LayerFacts:
    along_x = _differences(layer.colour, layer.cover, middle, span, every, axis=1)
    along_y = 0.0, 0.0
    if columns:
        along_y = _differences(layer.colour, layer.cover, middle, span, every, axis=0)
    return LayerFacts((along_x[0], along_y[0]), (along_x[1], along_y[1]))


def _differences(
    colour: Image, cover: Image | None, middle: float, span: float, every: int, axis: int
) -> tuple[float, float]:
    step, bend = 0.0, 0.0
    for part, covered in _parts(colour, cover, every, axis):
        if covered is None:
            first, second = _extremes(part, axis)
        else:
            edge = _extremes(covered, axis)
            first, second = _extremes(_against(part, covered, middle), axis)
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


def _extremes(values: Image, axis: int) -> tuple[float, float]:
    """Largest first and second difference along an axis; at the border mirrored."""
    if values.shape[axis] < 2:
        return 0.0, 0.0
    steps = _steps(values, axis)
    last = steps.shape[axis] - 1
    if not last:
        first = _largest(steps)
        return first, 2.0 * first
    ends = steps[::last] if axis == 0 else steps[:, ::last]
    return _largest(steps), max(2.0 * _largest(ends), _largest(_steps(steps, axis)))


def _steps(values: Image, axis: int) -> Image:
    """Differences of neighbours; NumPy's own takes as long again to find out what is asked."""
    return values[1:] - values[:-1] if axis == 0 else values[:, 1:] - values[:, :-1]


def _largest(values: Image) -> float:
    return float(max(values.max(), -values.min()))
