"""Demosaicing: three colours per pixel again."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effect import Effect, on_composite
from quizgen.camera.effects.mosaic import CHANNELS, MOSAIC, channel_pattern
from quizgen.camera.pixels.tiles import split_range
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.view import View


def run(raw: Image, view: View) -> Image:
    """Bilinear interpolation of a mosaic.

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
        _fill(result[start:stop], plane[start : stop + 2], channel_pattern(view))
    return result


_ROWS = 32
"""Rows at once, an even number: so few that they stay in the cache."""


def _fill(result: Image, plane: Image, tile: tuple[tuple[int, int], ...]) -> None:
    """A band of rows from as many of the plane and one on each side."""
    for row in (0, 1):
        for column in (0, 1):
            site = _neighbours(plane, row, column, green=tile[row][column] == CHANNELS["G"])
            for channel in range(3):
                where = _same_colour(tile, row, column, channel)
                result[row::2, column::2, channel] = site[where]


def _neighbours(plane: Image, row: int, column: int, *, green: bool) -> dict[str, Image]:
    """Means around every second place: a green site is beside the other colours, else across."""
    height, width = plane.shape[0] - 2, plane.shape[1] - 2

    def at(down: int, across: int) -> Image:
        top, left = row + 1 + down, column + 1 + across
        return plane[top : top + height - row : 2, left : left + width - column : 2]

    level, upright = at(0, -1) + at(0, 1), at(-1, 0) + at(1, 0)
    if green:
        return {"here": at(0, 0), "level": level * 0.5, "upright": upright * 0.5}
    corners = (at(-1, -1) + at(-1, 1)) + (at(1, -1) + at(1, 1))
    return {"here": at(0, 0), "cross": (level + upright) * 0.25, "corners": corners * 0.25}


def _same_colour(tile: tuple[tuple[int, int], ...], row: int, column: int, channel: int) -> str:
    """Where a colour is found around a place of the tile."""
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
