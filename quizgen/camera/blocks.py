"""Large pictures piece by piece, so that what lies in between stays in the processor's cache.

Pieces do not depend on how many cores share them, so neither do the results.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.floating]
Work = Callable[[Image, int], None]
"""Changes a flat piece of a picture in place; also gets the piece's number."""

BLOCK = 3 << 13
"""Values per piece: whole colours, 96 KiB."""

_WORTH_SHARING = 1 << 21
_MOST_CORES = 4


def for_pieces(length: int, piece: int, size: int, work: Callable[[int, int], None]) -> None:
    """Call ``work(start, stop)`` for consecutive pieces of [0, length).

    Parameters
    ----------
    length, piece : int
        How far to go, and how far at once.
    size : int
        Values to be worked on in all; only many are worth a second core.
    work : callable
        Must not depend on the order of the calls.
    """
    starts = range(0, length, piece)
    cores = min(_MOST_CORES, os.cpu_count() or 1) if size >= _WORTH_SHARING else 1

    def share(first: int) -> None:
        for start in starts[first::cores]:
            work(start, min(start + piece, length))

    if cores == 1:
        share(0)
        return
    with ThreadPoolExecutor(cores) as pool:
        list(pool.map(share, range(cores)))


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

    def one(start: int, stop: int) -> None:
        piece, ticks = result[start:stop], [perf_counter()]
        if not own:
            piece[...] = flat[start:stop]
        for work in works:
            work(piece, start // BLOCK)
            ticks.append(perf_counter())
        clock.append(ticks)

    for_pieces(flat.size, BLOCK, flat.size, one)
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
