"""Large pictures piece by piece, so that what lies in between stays in the processor's cache.

Pieces do not depend on how many cores share them, so neither do the results.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.float32]

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


def pointwise(values: Image, work: Callable[[Image, Image], None]) -> Image:
    """Fill a new picture piece by piece.

    Parameters
    ----------
    values : numpy.ndarray
        float32, any shape.
    work : callable
        Gets a flat piece of the values (to be left alone) and the piece of the result to fill.
        Pieces begin with a whole colour when the values do.
    """
    flat = np.ascontiguousarray(values, np.float32).reshape(-1)
    result = np.empty_like(flat)

    def one(start: int, stop: int) -> None:
        work(flat[start:stop], result[start:stop])

    for_pieces(flat.size, BLOCK, flat.size, one)
    return result.reshape(values.shape)
