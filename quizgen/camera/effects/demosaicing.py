"""Demosaicing: three colours per pixel again."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effect import Effect, on_composite
from quizgen.camera.effects.mosaic import CHANNELS, MOSAIC, channel_pattern
from quizgen.camera.pixels.tiles import split_range
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.view import View


def run(raw: Image, view: View) -> Image:
    """Return three colours per pixel from a mosaic, by bilinear interpolation.

    Parameters
    ----------
    raw : numpy.ndarray
        Shape (H, W, 1), H and W >= 2. The border is mirrored without repeating the edge, so that
        every neighbour keeps its colour (errata EC7).
    view : View
        Camera with a mosaic.
    """
    if raw.shape[2] != 1:
        return raw
    plane = np.pad(raw[..., 0], 1, mode="reflect")
    result = np.empty((*raw.shape[:2], 3), raw.dtype)
    for start, stop in split_range(len(raw), _ROWS):
        _fill_band(result[start:stop], plane[start : stop + 2], channel_pattern(view))
    return result


_ROWS = 32
"""Rows at once, an even number: so few that they stay in the cache."""


def _fill_band(result: Image, plane: Image, tile: tuple[tuple[int, int], ...]) -> None:
    """Fill an even number of rows of the result from the plane's same rows and one each side."""
    for row in (0, 1):
        for column in (0, 1):
            site = _average_neighbours(plane, row, column, green=tile[row][column] == CHANNELS["G"])
            for channel in range(3):
                where = _choose_average(tile, row, column, channel)
                result[row::2, column::2, channel] = site[where]


def _average_neighbours(plane: Image, row: int, column: int, *, green: bool) -> dict[str, Image]:
    """Return the averages around every site at (row, column) of the 2x2 tile, by where they lie.

    A green site has other colours left and right (``level``) and above and below (``upright``); any
    other site has green on four sides (``cross``) and the third colour in the ``corners``.
    """
    height, width = plane.shape[0] - 2, plane.shape[1] - 2

    def at(down: int, across: int) -> Image:
        """Return the values at an offset in rows and columns from these sites."""
        top, left = row + 1 + down, column + 1 + across
        return plane[top : top + height - row : 2, left : left + width - column : 2]

    level, upright = at(0, -1) + at(0, 1), at(-1, 0) + at(1, 0)
    if green:
        return {"here": at(0, 0), "level": level * 0.5, "upright": upright * 0.5}
    corners = (at(-1, -1) + at(-1, 1)) + (at(1, -1) + at(1, 1))
    return {"here": at(0, 0), "cross": (level + upright) * 0.25, "corners": corners * 0.25}


def _choose_average(tile: tuple[tuple[int, int], ...], row: int, column: int, channel: int) -> str:
    """Return the name of the average that gives a channel at a place of the tile."""
    here, beside = tile[row][column], tile[row][1 - column]
    if here == channel:
        return "here"
    if channel == CHANNELS["G"]:
        return "cross"
    if here != CHANNELS["G"]:
        return "corners"
    return "level" if beside == channel else "upright"


EFFECT = Effect(
    name="demosaicing",
    answers=("bayer", "demosaicing", "moire"),
    is_present=lambda view: view.camera[MOSAIC] != "",
    run=on_composite(run),
    omission_bound=lambda signal, _: signal.span,
    pair="bayer",
)
