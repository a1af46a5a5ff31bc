"""Layers that are moved or resampled, and what an error in one of them can show."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import product

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from quizgen.camera.blocks import pieces
from quizgen.camera.filters import convolve, sample
from quizgen.camera.kernels import Kernel
from quizgen.camera.raster.draw import (
    Box,
    Layer,
    Motion,
    Sheet,
    both,
    content,
    leaves_frame,
    sheets,
)
from quizgen.camera.raster.uneven import Places, blurred_places, extent, places, whole, wider
from quizgen.camera.scene import Image
from quizgen.camera.setup.body import VELOCITY
from quizgen.camera.view import Signal, View

Field = NDArray[np.float64]


Make = Callable[[list[Image], Box], list[Image]]
"""Makes colour and, but for an opaque layer, cover of a box anew."""

_ROWS, _COLUMNS = 256, 1024
"""Made at once, so that what lies in between stays small; more where a kernel is wide."""


def worked_on(
    layer: Layer, where: Places, make: Make, most: tuple[int, int] = (_ROWS, sys.maxsize)
) -> Layer:
    """A layer in which some places are made anew.

    Parameters
    ----------
    layer : Layer
    where : Places
    make : callable
        Gets colour and cover and what is wanted of them.
    most : (int, int)
        Rows and columns that are made at once, so that what lies in between stays small.
    """
    if not where.boxes:
        return layer
    images = [layer.colour] if layer.cover is None else [layer.colour, layer.cover]
    results = images if layer.own else [_copied(image, layer, where.boxes[0]) for image in images]
    made: list[Made] = []
    for box in sorted(_in_pieces(where.boxes, most), key=_top):
        # nothing may be written over while others still look at it
        done = _top(box) - (where.reach if results is images else 0)
        _write((one for one in made if one[0][0].stop <= done), results)
        made = [one for one in made if one[0][0].stop > done]
        made.append((box, make(images, box)))
    _write(made, results)
    cover = None if layer.cover is None else results[1]
    return replace(layer, colour=results[0], cover=cover, own=True)


Made = tuple[Box, list[Image]]


def _top(box: Box) -> int:
    return int(box[0].start)


def _write(made: Iterable[Made], results: list[Image]) -> None:
    for box, parts in made:
        for result, part in zip(results, parts, strict=True):
            result[box] = part


def _copied(image: Image, layer: Layer, first: Box) -> Image:
    """A copy of what stays; unlike in others, what is empty takes no memory."""
    if image[first].shape == image.shape:
        return np.empty(image.shape, image.dtype)
    if layer.cover is None:
        return image.copy()
    result: Image = np.zeros(image.shape, image.dtype)
    there = content(layer.cover)
    result[there] = image[there]
    return result


def _in_pieces(boxes: list[Box], most: tuple[int, int]) -> Iterator[Box]:
    for rows, columns in boxes:
        for top, bottom in pieces(rows.stop - rows.start, most[0]):
            for left, right in pieces(columns.stop - columns.start, most[1]):
                down = slice(rows.start + top, rows.start + bottom)
                yield down, slice(columns.start + left, columns.start + right)


def blurred(layer: Layer, kernel: Kernel) -> Layer:
    """A layer convolved with a kernel; colour and cover go through it together."""
    if kernel.size == 1:
        return layer
    down, across = (side // 2 for side in kernel.shape)

    def blur(images: list[Image], box: Box) -> list[Image]:
        seen = wider(box, (down, across), images[0].shape)
        top, left = (part.start - more.start for part, more in zip(box, seen, strict=True))
        light = [image[seen] for image in images]
        found = convolve(light[0] if len(light) == 1 else np.concatenate(light, axis=2), kernel)
        found = found[top:, left:][: box[0].stop - box[0].start, : box[1].stop - box[1].start]
        channels = images[0].shape[2]
        return [found[..., :channels], found[..., channels:]][: len(images)]

    most = max(_ROWS, 16 * down), max(_COLUMNS, 32 * across)
    return worked_on(layer, blurred_places(layer, kernel), blur, most)


def bound_layers(signal: Signal, view: View, share: Callable[[Sheet], float]) -> float:
    """Bound on what a picture shows of averages in its layers.

    An error of a layer shows as at most that of its colour plus half the range times that of its
    cover: one range in an opaque layer, one and a half in others. No average leaves the range.

    Parameters
    ----------
    signal : Signal
    view : View
    share : callable
        How far any value of a sheet's layer may be off, by its own range.
    """
    shares = (share(sheet) * (1.0 if sheet.opaque else 1.5) for sheet in sheets(view))
    return signal.span * min(sum(shares), 1.0)


def bound_shift(signal: Signal, view: View, distance: float) -> float:
    """Bound on reading every layer a distance away, px: neighbours may be black and white."""
    far = math.sqrt(2.0) * (distance + rounding(view))
    return bound_layers(signal, view, lambda _: far)


def farthest(view: View, reach: Callable[[Sheet], tuple[float, float]]) -> tuple[float, float]:
    """How far outside (across, down) any sheet is looked at; what is even there needs no margin."""
    reaches = [reach(sheet) for sheet in sheets(view) if leaves_frame(sheet, view)]
    across, down = zip((0.0, 0.0), *reaches, strict=True)
    return max(across), max(down)


def rounding(view: View) -> float:
    """How far positions in single precision may lie beside what they should be, px."""
    return _spacing(max(view.width, view.height))


@lru_cache(maxsize=64)
def _spacing(side: int) -> float:
    return float(np.spacing(np.float32(side)))


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

    def turn(images: list[Image], box: Box) -> list[Image]:
        return _turned(images, box, layer.motion, angles)

    where, near = places(layer, (reach, reach)), _round(layer)
    boxes = [part for box in where.boxes if (part := both(box, near)) is not None]
    return worked_on(layer, where._replace(boxes=boxes), turn, _TURNED)


def _round(layer: Layer) -> Box:
    """Where anything of a layer may get that turns about its pivot."""
    shape = layer.colour.shape
    ends = extent(layer)
    if any(not part.start or part.stop == side for part, side in zip(ends, shape, strict=False)):
        return whole(shape)  # its edge is repeated outward, and comes in from there
    (x, y), corners = layer.motion.pivot, product(*((part.start, part.stop) for part in ends))
    far = max(math.hypot(row - y, column - x) for row, column in corners) + 1.0
    rows, columns = (
        slice(max(math.floor(middle - far), 0), min(math.ceil(middle + far) + 1, side))
        for middle, side in zip((y, x), shape, strict=False)
    )
    return rows, columns


_TURNED = 128, 1024
"""Rows and columns turned at once: few calls, and all that they need is small."""


def _turned(
    images: list[Image], box: Box, motion: Motion, angles: Sequence[float | Field]
) -> list[Image]:
    height, width = images[0].shape[:2]
    x = np.arange(width)[None, box[1]] - motion.pivot[0]
    y = np.arange(height)[box[0], None] - motion.pivot[1]
    totals = [np.zeros((y.size, x.size, image.shape[2]), image.dtype) for image in images]
    for angle in angles:
        by_row = angle if isinstance(angle, float) else angle[box[0]]
        cosine, sine = np.cos(by_row), np.sin(by_row)
        column = (cosine * x + sine * y + motion.pivot[0]).astype(images[0].dtype)
        row = (cosine * y - sine * x + motion.pivot[1]).astype(images[0].dtype)
        for place, image in enumerate(images):
            totals[place] += sample(image, column, row)
    return [total * (1.0 / len(angles)) for total in totals]


# Margins


def cropped(layer: Layer, view: View) -> Layer:
    """The middle of a layer that was drawn or computed with a wider margin: nothing is copied."""
    height, width = layer.colour.shape[:2]
    down, across = (height - view.height) // 2, (width - view.width) // 2
    if not down and not across:
        return layer
    part = slice(down, down + view.height), slice(across, across + view.width)
    cover, (x, y) = layer.cover, layer.motion.pivot
    motion = replace(layer.motion, pivot=(x - across, y - down))
    seen = None if cover is None else cover[part]
    return replace(layer, colour=layer.colour[part], cover=seen, motion=motion)


def moved_together(picture: Image, view: View) -> Image:
    """The middle of a picture nobody else needs, row after row in the memory of the whole.

    New memory for a large picture takes longer than copying it.
    """
    down, across = (picture.shape[0] - view.height) // 2, (picture.shape[1] - view.width) // 2
    if not down and not across:
        return picture
    if not picture.flags.c_contiguous:
        return picture[down : down + view.height, across : across + view.width]
    length, flat = view.width * picture.shape[2], picture.reshape(-1)
    for row in range(view.height):  # what is written lies before all that is still to be read
        line = picture[down + row, across : across + view.width]
        flat[row * length : (row + 1) * length] = line.reshape(-1)
    return flat[: view.height * length].reshape(view.height, view.width, -1)
