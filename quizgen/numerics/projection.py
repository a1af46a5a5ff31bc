"""Pixel coordinates of the pinhole camera, u = o + f x/(pitch z)."""

from __future__ import annotations

import math

import numpy as np
from flint import fmpq

from quizgen.numerics.domain import POSITIVE, REAL, Constraint
from quizgen.numerics.rational import nearest_double, shortest_decimal
from quizgen.numerics.typing import Array, FloatOrArray, Numbers
from quizgen.numerics.ufunc import StableUfunc, all_within


def _compute_pixel(f: Array, pitch: Array, x: Array, z: Array, o: Array) -> Array:
    u: Array = o + f * x / (pitch * z)
    odd = np.zeros(u.size, dtype=bool)
    for arg in (f, pitch, x, z, o):
        size = np.abs(arg)
        odd |= (size > _REACH) | ((size < 1 / _REACH) & (size > 0))
    where = np.flatnonzero(odd)
    if where.size:
        parts = (arg.take(where) if arg.size > 1 else arg for arg in (f, pitch, x, z, o))
        u[where] = _pixel_of_mantissas(*parts)
    return u


def _pixel_of_mantissas(f: Array, pitch: Array, x: Array, z: Array, o: Array) -> Array:
    """The formula with powers of two taken out, so that only the result can leave the range."""
    (f, f2), (pitch, pitch2), (x, x2), (z, z2), (o, o2) = map(np.frexp, (f, pitch, x, z, o))
    shift2 = np.where(x == 0, o2, f2 + x2 - pitch2 - z2)
    most = np.maximum(shift2, o2)
    total = np.ldexp(f * x / (pitch * z), shift2 - most) + np.ldexp(o, o2 - most)
    result: Array = np.ldexp(total, most)
    return result


def _pixel_of_decimals(*args: fmpq) -> fmpq:
    f, pitch, x, z, o = (shortest_decimal(nearest_double(arg)) for arg in args)
    return o + f * x / (pitch * z)


def _to_be_read(*_args: Array) -> Array:
    return np.full(1, np.nan)


_REACH = 2.0**300
"""Products of two such numbers neither overflow nor lose digits."""


def _pixel_at_once(u: Array, f: Array, pitch: Array, x: Array, z: Array, o: Array) -> bool:
    """The formula, and whether all numbers are moderate and z is not 0.

    A finite sum has finite summands, so x is finite and nothing overflowed. A tiny x may lose its
    digits, but not next to an o that is not.
    """
    np.multiply(f, x, out=u)
    u /= pitch * z
    u += o
    return (
        all_within(f, 1 / _REACH, _REACH)
        and all_within(pitch, 1 / _REACH, _REACH)
        and (all_within(o, 1 / _REACH, _REACH) or all_within(o, -_REACH, -1 / _REACH))
        and (all_within(z, 1 / _REACH, _REACH) or all_within(z, -_REACH, -1 / _REACH))
        and math.isfinite(u.sum())
    )


_SPANS = (POSITIVE, POSITIVE, REAL, REAL, REAL)
_ON_PLANE = Constraint(
    "on-camera-plane",
    lambda _f, _pitch, _x, z, _o: z == 0,
    lambda _f, _pitch, _x, z, _o: bool(z[0] <= 0 <= z[1]),
)
_PIXEL = StableUfunc(_compute_pixel, _SPANS, (_ON_PLANE,), shortcut=_pixel_at_once)
_PIXEL_ALONE = StableUfunc(_to_be_read, _SPANS, (_ON_PLANE,), exact=_pixel_of_decimals)


def pixel_coordinate(
    f: Numbers, pitch: Numbers, x: Numbers, z: Numbers, o: Numbers
) -> FloatOrArray:
    """Pixel coordinate u = o + f x/(pitch z) of a point.

    Parameters
    ----------
    f, pitch : array_like
        Focal length and distance of pixel centres, > 0, same unit (per pixel).
    x, z : array_like
        Coordinate across and depth, same unit. With y upwards pass -y.
    o : array_like
        Principal point in pixels.

    Returns
    -------
    float or array
        Pixels. Numbers alone are read as the decimals that they print as, and
        the answer is correctly rounded: 2 mm, 5 um, -1, 2 and 320 give 120, where doubles give
        119.99999999999997. In arrays the formula is taken as it stands: three roundings of
        f x/(pitch z), each at most one unit in its last place, and one of the sum, half a unit of
        it. Off by at most 4 units in the last place of the larger of the two terms, whatever the
        magnitudes.

    Raises
    ------
    DomainError
        ``on-camera-plane`` (z = 0).
    """
    alone = all(np.ndim(arg) == 0 for arg in (f, pitch, x, z, o))
    return (_PIXEL_ALONE if alone else _PIXEL)(f, pitch, x, z, o)
