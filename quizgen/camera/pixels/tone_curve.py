"""Tone curves in single precision from a table, multiplications and additions only.

Library powers differ in the last bit between processors, and a last bit can flip an 8-bit level.
The leading bits of a number (its exponent and ten bits more) choose a straight line that is off by
less than a quarter of the last bit; the line is evaluated the same way everywhere.

`quizgen.numerics.gamma` decodes, in double precision; the tests hold the two together.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image

SRGB_KNEE = 0.0031308

CURVE_ERROR = 1e-6
"""Absolute error of computed tone curves and hues."""

_CELLS = 1 << 10
_SHIFT = np.int32(13)
_OCTAVES = 127

Field = NDArray[np.float64]


def _cell_powers(exponent: float, first: int = 0) -> Field:
    """Return m^exponent for the middle m of every cell: a row per octave, subnormal first."""
    middles = (1.0 + (cell + 0.5) / _CELLS for cell in range(_CELLS))
    within = np.array([math.pow(middle, exponent) for middle in middles])
    octaves = [math.pow(2.0, exponent * (n - _OCTAVES)) for n in range(first, _OCTAVES)]
    if not first:
        octaves[0] = 0.0
    return np.outer(octaves, within).reshape(-1)


@cache
def _cell_tangents(exponent: float, first: int = 0) -> tuple[Field, Field]:
    """Return offset and slope of the tangent to x^exponent in every cell, exactly 1 at 1.

    A tangent is off by e(e-1)/2 d^2 at a relative distance d, at most half a cell: half of the
    largest such error is taken off, 1.5e-8 of the value remains. Octaves before the first one
    are left out.
    """
    powers = _cell_powers(exponent, first)
    lowered = exponent * (1.0 - exponent) / 16.0 / _CELLS**2
    offsets = powers * (1.0 - exponent - lowered)
    slopes = np.zeros_like(powers)
    np.divide(exponent * powers, _cell_powers(1.0, first), out=slopes, where=powers > 0.0)
    return np.append(offsets, 1.0), np.append(slopes, 0.0)


@cache
def _curve_cells(gamma: str | float) -> tuple[Image, Image]:
    """Return offset and slope by cell of a tone curve.

    Dark cells of sRGB lie on its straight line.
    """
    if gamma != "srgb":
        offsets, slopes = _cell_tangents(1.0 / float(gamma))
        return offsets.astype(np.float32), slopes.astype(np.float32)
    first = _OCTAVES + math.frexp(SRGB_KNEE)[1] - 1
    offsets, slopes = _cell_tangents(1.0 / 2.4, first)
    dark = np.append(_cell_powers(1.0, first) <= SRGB_KNEE, False)
    start, count = first * _CELLS, _OCTAVES * _CELLS + 1
    whole: tuple[Image, Image] = np.zeros(count, np.float32), np.full(count, 12.92, np.float32)
    whole[0][start:] = np.where(dark, 0.0, 1.055 * offsets - 0.055)
    whole[1][start:] = np.where(dark, 12.92, 1.055 * slopes)
    return whole


def encode_piecewise(gamma: str | float) -> TileOperation:
    """Return what encodes the linear light of a tile, by a straight line in each cell.

    Values are clipped to [0, 1] first; subnormal ones count as 0. Within 3e-7 of the true value.

    Parameters
    ----------
    gamma : str or float
        ``srgb`` (IEC 61966-2-1: 12.92 x below 0.0031308, else 1.055 x^(1/2.4) - 0.055), or an
        exponent g >= 1 for x^(1/g).
    """
    if gamma == "linear":
        return _clip_tile
    offsets, slopes = _curve_cells(gamma)

    def work(part: Image, _: Tile) -> None:
        """Encode a tile in place."""
        values = np.clip(part, 0.0, 1.0)
        cell = np.right_shift(values.view(np.int32), _SHIFT).astype(np.intp)
        # all cells exist: to wrap around is the fastest check
        np.take(slopes, cell, out=part, mode="wrap")
        part *= values
        np.take(offsets, cell, out=values, mode="wrap")
        part += values

    return work


def _clip_tile(part: Image, _: Tile) -> None:
    """Clip a tile to [0, 1] in place."""
    np.clip(part, 0.0, 1.0, out=part)


def encode_exact(gamma: str | float) -> TileOperation:
    """Return what encodes a tile in double precision, by the library's powers."""
    if gamma == "linear":
        return _clip_tile

    def work(part: Image, _: Tile) -> None:
        """Encode a tile in place."""
        np.clip(part, 0.0, 1.0, out=part)
        if gamma != "srgb":
            np.power(part, 1.0 / float(gamma), out=part)
            return
        bright = 1.055 * part ** (1.0 / 2.4) - 0.055
        part[...] = np.where(part <= SRGB_KNEE, 12.92 * part, bright)

    return work


def encode_value(value: float, gamma: str | float) -> float:
    """Return one number encoded in double precision, as the bounds need it."""
    if not 0.0 <= value <= 1.0:
        value = min(max(value, 0.0), 1.0)
    if gamma == "srgb":
        return 12.92 * value if value <= SRGB_KNEE else 1.055 * value ** (1.0 / 2.4) - 0.055
    return value if gamma == "linear" else float(value ** (1.0 / float(gamma)))
