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
    """Return u = o + f x/(pitch z) of a block in doubles, scaled where a product could overflow."""
    u: Array = o + f * x / (pitch * z)
    odd = np.zeros(u.size, dtype=bool)
    for arg in (f, pitch, x, z, o):
        size = np.abs(arg)
        odd |= (size > _REACH) | ((size < 1 / _REACH) & (size > 0))
    where = np.flatnonzero(odd)
    if where.size:
        parts = (arg.take(where) if arg.size > 1 else arg for arg in (f, pitch, x, z, o))
        u[where] = _compute_scaled_pixel(*parts)
    return u


def _compute_scaled_pixel(f: Array, pitch: Array, x: Array, z: Array, o: Array) -> Array:
    """Return u with powers of two taken out, so that only the result can leave the range."""
    (f, f2), (pitch, pitch2), (x, x2), (z, z2), (o, o2) = map(np.frexp, (f, pitch, x, z, o))
    shift2 = np.where(x == 0, o2, f2 + x2 - pitch2 - z2)
    most = np.maximum(shift2, o2)
    total = np.ldexp(f * x / (pitch * z), shift2 - most) + np.ldexp(o, o2 - most)
    result: Array = np.ldexp(total, most)
    return result


def _compute_decimal_pixel(*args: fmpq) -> fmpq:
    """Return u exactly, with each argument read as the shortest decimal that it prints as."""
    f, pitch, x, z, o = (shortest_decimal(nearest_double(arg)) for arg in args)
    return o + f * x / (pitch * z)


def _request_exact(*_args: Array) -> Array:
    """Return a NaN, which has `StableUfunc` compute the element by fractions."""
    return np.full(1, np.nan)


_REACH = 2.0**300
"""Products of two such numbers neither overflow nor lose digits."""


def _fill_pixels(u: Array, f: Array, pitch: Array, x: Array, z: Array, o: Array) -> bool:
    """Fill u of a block, and return whether all numbers are moderate and z is never 0.

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
_PIXEL = StableUfunc(_compute_pixel, _SPANS, (_ON_PLANE,), shortcut=_fill_pixels)
_PIXEL_ALONE = StableUfunc(_request_exact, _SPANS, (_ON_PLANE,), exact=_compute_decimal_pixel)


def pixel_coordinate(
    f: Numbers, pitch: Numbers, x: Numbers, z: Numbers, o: Numbers
) -> FloatOrArray:
    """Return the pixel coordinate u = o + f x/(pitch z) of a point seen by a pinhole camera.

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
