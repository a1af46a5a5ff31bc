"""Which parts of a picture a drawn thing covers as a whole, and where nothing of it is.

A band of rows is as high as a cell; of what covers or leaves out all of a cell no edge is computed.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

CELL = 64
"""Columns of a cell, and rows unless the picture is narrow."""
_WIDE = 16
"""Cells drawn at once, few enough for the cache."""

States = NDArray[np.int8]
"""Of each row and column of cells: `NOTHING` of a thing, an edge of it maybe, or `ALL` covered."""
NOTHING, ALL = 0, 2


def band(width: int) -> int:
    """Rows of a cell: as many pixels in more rows, where the picture is narrow."""
    return max(CELL, _WIDE * CELL * CELL // width)


def states(away: NDArray[np.float64], reach: float) -> States:
    """What becomes of cells.

    Parameters
    ----------
    away : numpy.ndarray
        From `quizgen.camera.raster.outlines.CLOSEST` in the middle of each.
    reach : float
        From there to a corner, px; the soft edge is half a pixel more.
    """
    far = reach + 0.5
    return np.asarray(1 - (away >= far) + (away <= -far), np.int8)


def runs(row: list[int]) -> Iterator[tuple[slice, bool]]:
    """Cells beside each other that are covered alike, unless not at all, and whether all are."""
    start = 0
    for state, alike in groupby(row):
        stop = start + len(list(alike))
        if state != NOTHING:
            for first in range(start, stop, _WIDE):
                yield slice(first, min(first + _WIDE, stop)), state == ALL
        start = stop
