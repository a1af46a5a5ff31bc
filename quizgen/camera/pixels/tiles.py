"""Large pictures tile by tile, so that what lies in between stays in the processor's cache.

One after the other: in so small a tile a call of NumPy takes microseconds, and threads that hand
over the interpreter's lock after each took twice as long as one, and four times the processor time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from time import perf_counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.setup.scene import Image

TILE_SIDES = 64, 128
"""Rows and columns of a tile."""
TILE_VALUES = 3 * TILE_SIDES[0] * TILE_SIDES[1]
"""Values of the largest tile: whole colours, 96 KiB."""


class Tile(NamedTuple):
    """A part of a picture: its number, which seeds its noise, and its slices."""

    number: int
    place: tuple[slice, ...]

    @property
    def pixels(self) -> int:
        """The number of pixels of the tile."""
        return math.prod(part.stop - part.start for part in self.place)


TileOperation = Callable[[Image, Tile], None]
"""Changes the values of a tile, which lie behind each other, in place."""


def split_range(length: int, size: int) -> Iterator[tuple[int, int]]:
    """Yield start and stop of consecutive pieces of [0, length), the last one maybe smaller."""
    for start in range(0, length, size):
        yield start, min(start + size, length)


def iter_tiles(shape: tuple[int, ...]) -> Iterator[Tile]:
    """Yield the tiles of a picture (H, W, C), row by row, or of a row of values."""
    if len(shape) == 1:
        for number, part in enumerate(split_range(shape[0], TILE_VALUES)):
            yield Tile(number, (slice(*part),))
        return
    rows, columns = (list(split_range(*sides)) for sides in zip(shape, TILE_SIDES, strict=False))
    places = ((slice(*down), slice(*across)) for down in rows for across in columns)
    for number, place in enumerate(places):
        yield Tile(number, place)


def apply_tilewise(
    values: Image,
    works: Sequence[TileOperation],
    *,
    into: Image | None = None,
) -> tuple[Image, NDArray[np.float64]]:
    """Return a picture changed tile by tile, each by all works while it is in the cache.

    Parameters
    ----------
    values : numpy.ndarray
        A picture of shape (H, W, C), or of any other shape; float32 or float64.
    works : sequence of callable
        In this order.
    into : numpy.ndarray, optional
        Where the result is written, maybe over the values themselves.

    Returns
    -------
    numpy.ndarray
        The picture.
    numpy.ndarray
        Seconds that each work took.
    """
    seen = values if values.ndim == 3 else np.ascontiguousarray(values).reshape(-1)
    result = np.empty(seen.shape, seen.dtype) if into is None else into.reshape(seen.shape)
    scratch, clock = np.empty(TILE_VALUES, seen.dtype), np.zeros(len(works))
    for tile in iter_tiles(seen.shape):
        source = seen[tile.place]
        part = scratch[: source.size]
        part.reshape(source.shape)[...] = source
        ticks = [perf_counter()]
        for work in works:
            work(part, tile)
            ticks.append(perf_counter())
        clock += np.diff(ticks)
        result[tile.place] = part.reshape(source.shape)
    return result.reshape(values.shape), clock


def multiply_by(factor: float) -> TileOperation:
    """Return what multiplies a tile by one factor."""
    scale = float(factor)  # a number of Python takes the precision of the picture

    def work(part: Image, _: Tile) -> None:
        """Multiply a tile in place."""
        part *= scale

    return work


def multiply_by_map(factors: Image) -> TileOperation:
    """Return what multiplies the three channels of every pixel by one factor, shape (H, W, 1)."""

    def work(part: Image, tile: Tile) -> None:
        """Multiply a tile in place by its part of the map."""
        own = factors[tile.place].reshape(-1)
        for channel in range(3):
            part[channel::3] *= own

    return work
