"""Where a layer is not even: only there can averages of its values change anything.

A layer is looked at in small squares, each with the next pixel to the right and below, so that
squares beside each other that are even have one colour. What lies so far inside of even squares
that an effect sees nothing else stays exactly as it is.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterator
from functools import reduce
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.raster.rasterizer import Layer, PixelBox, bounding_box, intersect_boxes
from quizgen.camera.setup.scene import Image

Squares = NDArray[np.bool_]
"""Whether each square is meant: rows and columns of squares."""

SQUARE = 32
"""Side of the squares, px."""
_MOST = 0.5
"""Share of squares from which on the others are not looked for: most pictures are even nowhere."""
_CALL = 4096
"""Pixels that could be worked on in the time that one more box takes."""


class Regions(NamedTuple):
    """The boxes of a layer outside which an effect changes nothing; they may overlap.

    Parameters
    ----------
    boxes : list of (slice, slice)
    reach : int
        Rows above and below each that may be looked at.
    """

    boxes: list[PixelBox]
    reach: int


def sampled_regions(layer: Layer, reach: tuple[float, float]) -> Regions:
    """Return the regions that change if values are read so far from their pixels.

    Parameters
    ----------
    layer : Layer
    reach : (float, float)
        How far across and down from a pixel that may be, px.
    """
    sides = layer.colour.shape[1::-1]
    across, down = (math.ceil(min(far, side)) + 1 for far, side in zip(reach, sides, strict=True))
    return Regions(_find_uneven_boxes(layer, (down, across), (0, 0)), down)


def regions_changed_by_blur(layer: Layer, kernel: NDArray[np.float64]) -> Regions:
    """Return the regions outside which convolving a layer with a kernel changes nothing.

    Near boxes are merged: each reads a margin of the kernel's reach, so many small ones are dear.
    """
    reach = kernel.shape[0] // 2, kernel.shape[1] // 2
    return Regions(_find_uneven_boxes(layer, reach, reach), reach[0])


def _find_uneven_boxes(
    layer: Layer, reach: tuple[int, int], read: tuple[int, int]
) -> list[PixelBox]:
    """Return boxes of what lies within ``reach`` rows and columns of anything uneven.

    ``read`` is the margin that each box reads, by which merging is decided.
    """
    seen = content_box(layer)
    squares = _find_uneven_squares(layer, seen)
    down, across = (-(-far // SQUARE) for far in reach)
    squares = _dilate_squares(_dilate_squares(squares, down).T, across).T
    most = grow_box(seen, reach, layer.colour.shape)
    boxes = (
        (slice(top * SQUARE, bottom * SQUARE), slice(left * SQUARE, right * SQUARE))
        for top, bottom, left, right in _merge_squares(squares, read)
    )
    return [part for box in boxes if (part := intersect_boxes(box, most)) is not None]


def content_box(layer: Layer) -> PixelBox:
    """Return the box outside which a layer is empty."""
    return full_box(layer.colour.shape) if layer.cover is None else bounding_box(layer.cover)


def grow_box(box: PixelBox, far: tuple[int, int], shape: tuple[int, ...]) -> PixelBox:
    """Return a box with more rows and columns on each side, within the picture.

    An empty box stays empty.
    """
    if not box[0].stop:
        return box
    rows, columns = (
        slice(max(part.start - more, 0), min(part.stop + more, length))
        for part, more, length in zip(box, far, shape, strict=False)
    )
    return rows, columns


def full_box(shape: tuple[int, ...]) -> PixelBox:
    """Return the box of all rows and columns."""
    return slice(0, shape[0]), slice(0, shape[1])


def _find_uneven_squares(layer: Layer, seen: PixelBox) -> Squares:
    """Return flags of the squares of a layer with more than one colour or coverage."""
    if layer.cover is None:
        return _compare_squares(layer.colour)
    found = np.zeros([-(-length // SQUARE) for length in layer.colour.shape[:2]], bool)
    if not seen[0].stop:
        return found
    # what is not empty may begin where a square does: then the one before it is not even
    rows, columns = (
        slice(max(part.start // SQUARE - 1, 0), -(-part.stop // SQUARE)) for part in seen
    )
    box = tuple(slice(part.start * SQUARE, part.stop * SQUARE + 1) for part in (rows, columns))
    both = _compare_squares(layer.colour[box]) | _compare_squares(layer.cover[box])
    found[rows, columns] = both[: rows.stop - rows.start, : columns.stop - columns.start]
    return found


def _compare_squares(values: Image) -> Squares:
    """Return flags of the squares whose pixels differ, or differ from the next right or below."""
    channels = values.shape[2]
    side = SQUARE * channels
    flat = values.reshape(len(values), -1)
    starts = np.arange(0, flat.shape[1], side)
    differ = np.zeros((len(range(0, len(flat), SQUARE)), flat.shape[1]), bool)
    first = flat[::SQUARE]
    np.not_equal(first[:, channels:], first[:, :-channels], out=differ[:, :-channels])
    found: Squares = np.logical_or.reduceat(differ, starts, axis=1)
    if found.mean() > _MOST:
        return np.ones(found.shape, bool)
    for number, row in enumerate(found):
        maybe = np.flatnonzero(~row)
        if maybe.size:
            among = slice(maybe[0], maybe[-1] + 1)
            part = slice(among.start * side, among.stop * side)
            band = flat[number * SQUARE : (number + 1) * SQUARE + 1, part]
            differs = (band[1:] != band[0]).any(axis=0)
            row[among] |= np.logical_or.reduceat(differs, starts[among] - part.start)
    return found


def _dilate_squares(squares: Squares, far: int) -> Squares:
    """Return flags of the squares within ``far`` rows of a flagged one."""
    if not far or squares.all():
        return squares
    before = np.zeros((len(squares) + 1, squares.shape[1]), int)
    np.cumsum(squares, axis=0, out=before[1:])
    rows = np.arange(len(squares))
    first, last = np.maximum(rows - far, 0), np.minimum(rows + far + 1, len(squares))
    return np.asarray(before[last] > before[first])


class _Frame(NamedTuple):
    """A rectangle of squares: first and last (exclusive) row and column."""

    top: int
    bottom: int
    left: int
    right: int

    def around(self, other: _Frame) -> _Frame:
        """Return the smallest frame around two."""
        top, left = min(self.top, other.top), min(self.left, other.left)
        return _Frame(top, max(self.bottom, other.bottom), left, max(self.right, other.right))

    def cost(self, read: tuple[int, int]) -> int:
        """Return the number of pixels read for a frame, with its margin of rows and columns."""
        down, across = read
        height, width = (self.bottom - self.top) * SQUARE, (self.right - self.left) * SQUARE
        kernel = 16 * down * across  # transformed, where it is wide
        return (height + 2 * down) * (width + 2 * across) + kernel + _CALL


def _merge_squares(squares: Squares, read: tuple[int, int]) -> list[_Frame]:
    """Return frames around all flagged squares; two become one where that reads fewer pixels."""
    done: list[_Frame] = []
    above: list[_Frame] = []
    edges = np.diff(squares.astype(np.int8), axis=1, prepend=0, append=0)
    for number, row in enumerate(edges):
        ends = np.flatnonzero(row).reshape(-1, 2).tolist()  # where runs of squares begin and end
        runs = _merge_row((_Frame(number, number + 1, *run) for run in ends), read)
        rights, more = [run.right for run in runs], list(runs)
        for frame in above:
            below = bisect_right(rights, frame.left)  # others have no column in common with it
            if below < len(runs) and _is_merge_cheaper(frame, more[below], read):
                more[below] = more[below].around(frame)
            else:
                done.append(frame)
        above = more
    done += above
    if not done:
        return []
    everything = reduce(_Frame.around, done)
    whole = everything.cost(read) <= sum(frame.cost(read) for frame in done)
    return [everything] if whole else done


def _is_merge_cheaper(one: _Frame, other: _Frame, read: tuple[int, int]) -> bool:
    """Return whether one frame around two reads fewer pixels than both."""
    return one.around(other).cost(read) <= one.cost(read) + other.cost(read)


def _merge_row(frames: Iterator[_Frame], read: tuple[int, int]) -> list[_Frame]:
    """Return the frames of one row, neighbours merged where that is cheaper."""
    found: list[_Frame] = []
    for frame in frames:
        if found and _is_merge_cheaper(found[-1], frame, read):
            found[-1] = found[-1].around(frame)
        else:
            found.append(frame)
    return found
