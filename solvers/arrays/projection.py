"""Pinhole projection and pixel coordinates.

Sources: x = f p_x/p_z; u = o + f p_x/(pitch p_z). Pixel coordinates read their arguments as
decimals, because an integer answer is then an integer (2 mm, 5 um, -1, 2 and offset 320 give
120, where doubles alone give 119.99999999999997).
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from .domain import POSITIVE, REAL, Array, Kernel, Numbers, Result, Rule
from .double_double import pairs

_LARGEST = 2.0**53
_SCALES = (1, 10**3, 10**6, 10**9)
_NEXT_TO_HALF = 2.0**-20


class Projected(NamedTuple):
    """Image coordinates, and whether the point lies behind the camera (p_z < 0)."""

    x: Result
    y: Result
    behind: Any


_ON_PLANE = Rule("on-camera-plane", lambda _f, _x, z: z == 0)
_PROJECT = Kernel(
    lambda f, x, z: (f * x / z, None),
    (POSITIVE, REAL, REAL),
    (_ON_PLANE,),
    exact=lambda f, x, z: f * x / z,
    reach=2.0**300,
)


def project(f: Numbers, p_x: Numbers, p_y: Numbers, p_z: Numbers) -> Projected:
    """Project points given in the camera frame.

    Parameters
    ----------
    f : array_like
        Focal length, > 0.
    p_x, p_y, p_z : array_like
        Coordinates, same unit among themselves; the results have the unit of f.

    Returns
    -------
    Projected
        ``x``, ``y`` and ``behind``. A point behind the camera has coordinates but no image.

    Raises
    ------
    DomainError
        ``on-camera-plane`` (p_z = 0), ``not-positive``, ``not-finite`` (arrays: masked).
    """
    return Projected(_PROJECT(f, p_x, p_z), _PROJECT(f, p_y, p_z), behind(p_z))


def behind(p_z: Numbers) -> Any:
    """Tell whether points lie behind the camera.

    Parameters
    ----------
    p_z : array_like
        Depths.

    Returns
    -------
    bool or array of bool
    """
    flags = np.asarray(p_z, dtype=np.float64) < 0
    return bool(flags) if flags.shape == () else flags


def _pixel(f: Any, pitch: Any, x: Any, z: Any, o: Any) -> Any:
    return o + f * x / (pitch * z)


def _decimal_pixel(*args: Fraction) -> Fraction:
    result: Fraction = _pixel(*[Fraction(repr(float(arg))) for arg in args])
    return result


def _pixels(f: Array, pitch: Array, x: Array, z: Array, o: Array) -> Any:
    exact = _by_integers(f, pitch, x, z, o)
    if exact is not None:
        return exact, None
    value = _pixel(*pairs(f, pitch, x, z, o)).rounded()
    twice = 2 * value
    cancelled = np.abs(value) < np.abs(value - o)
    return value, cancelled | (np.abs(twice - np.rint(twice)) < _NEXT_TO_HALF)


def _by_integers(*columns: Array) -> Array | None:
    """o + f x/(pitch z) as one quotient of exactly known integers, or None if they are long."""
    found = [_integers(column) for column in columns]
    known = [one for one in found if one is not None]
    if len(known) < len(columns):
        return None
    (f, pitch, x, z, o), (by_f, by_pitch, by_x, by_z, by_o) = zip(*known, strict=True)
    left, right = by_f * by_x, by_o * by_pitch * by_z
    common = math.gcd(left, right)
    left, right = left // common, right // common
    largest = [float(np.abs(column).max()) for column in (f, pitch, x, z, o)]
    depth = largest[1] * largest[3] * left
    if max(depth * by_o, depth * largest[4] + largest[0] * largest[2] * right) >= _LARGEST:
        return None
    below = pitch * z * float(left)
    result: Array = (o * below + f * x * float(right)) / (below * float(by_o))
    return result


def _integers(values: Array) -> tuple[Array, int] | None:
    """Integers m and a power of ten with values = m/10**k, all read as decimals."""
    for scale in _SCALES:
        whole = np.rint(values * float(scale))
        if np.array_equal(whole / float(scale), values):
            return whole, scale
    return None


_PIXEL = Kernel(
    _pixels,
    (POSITIVE, POSITIVE, REAL, REAL, REAL),
    (Rule("on-camera-plane", lambda _f, _pitch, _x, z, _o: z == 0),),
    exact=_decimal_pixel,
)


def pixel(f: Numbers, pitch: Numbers, x: Numbers, z: Numbers, o: Numbers) -> Result:
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
        Pixels. Arguments are read as decimals (0.1 is one tenth). Scalars are correctly
        rounded. Arrays are correctly rounded when the decimals have at most nine places and
        their integers stay below 2**53; longer ones are within 4 units in the last place, and
        settled exactly (10 us each) next to whole and half pixels and where terms cancel.

    Raises
    ------
    DomainError
        ``on-camera-plane`` (z = 0), ``not-positive``, ``not-finite`` (arrays: masked).
    """
    if all(np.ndim(arg) == 0 for arg in (f, pitch, x, z, o)):
        return _pixel_scalar(f, pitch, x, z, o)
    return _PIXEL(f, pitch, x, z, o)


_PIXEL_SCALAR = Kernel(
    lambda *args: (np.zeros(1), np.ones(1, dtype=bool)),
    _PIXEL.spans,
    _PIXEL.rules,
    exact=_decimal_pixel,
)


def _pixel_scalar(*args: Any) -> float:
    result: float = _PIXEL_SCALAR(*args)
    return result


