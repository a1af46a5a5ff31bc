"""Large pictures piece by piece, so that what lies in between stays in the processor's cache.

One after the other: in so small a piece a call of NumPy takes microseconds, and threads that hand
over the interpreter's lock after each took twice as long as one, and four times the processor time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.floating]
Work = Callable[[Image, int], None]
"""Changes a flat piece of a picture in place; also gets the piece's number."""

BLOCK = 3 << 13
"""Values per piece: whole colours, 96 KiB."""


def pieces(length: int, size: int) -> Iterator[tuple[int, int]]:
    """Start and stop of consecutive pieces of [0, length), the last one maybe smaller."""
    for start in range(0, length, size):
        yield start, min(start + size, length)


def in_turn(
    values: Image, works: Sequence[Work], *, own: bool = False
) -> tuple[Image, NDArray[np.float64]]:
    """Change a picture piece by piece, every piece by all works while it is in the cache.

    Parameters
    ----------
    values : numpy.ndarray
        Any shape, float32 or float64.
    works : sequence of callable
        In this order.
    own : bool
        Whether nobody else needs the values, so that they may be written over.

    Returns
    -------
    numpy.ndarray
        The picture.
    numpy.ndarray
        Seconds that each work took.
    """
    flat = np.ascontiguousarray(values).reshape(-1)
    result = flat if own else np.empty_like(flat)
    clock: list[list[float]] = []

    for start, stop in pieces(flat.size, BLOCK):
        piece, ticks = result[start:stop], [perf_counter()]
        if not own:
            piece[...] = flat[start:stop]
        for work in works:
            work(piece, start // BLOCK)
            ticks.append(perf_counter())
        clock.append(ticks)
    return result.reshape(values.shape), np.diff(clock, axis=1).sum(axis=0)


def times(factor: float) -> Work:
    """Multiply everything."""
    scale = float(factor)  # a number of Python takes the precision of the picture

    def work(part: Image, _: int) -> None:
        part *= scale

    return work


def at_pixels(factors: Image) -> Work:
    """Multiply every pixel's three channels by a factor of its own."""
    flat, pixels = factors.reshape(-1), BLOCK // 3

    def work(part: Image, piece: int) -> None:
        own = flat[piece * pixels :][: part.size // 3]
        for channel in range(3):
            part[channel::3] *= own

    return work
