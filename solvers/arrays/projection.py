"""Pinhole projection and pixel coordinates.

Sources: x = f p_x/p_z; u = o + f p_x/(pitch p_z). Pixel coordinates read their arguments as
decimals, because an integer answer is then an integer (2 mm, 5 um, -1, 2 and offset 320 give
120, where doubles alone give 119.99999999999997).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from .domain import POSITIVE, REAL, WIDE_BLOCK, Array, Kernel, Numbers, Result, Rule
from .double_double import pairs

_LARGEST = 2.0**53
_SCALES = (1, 10, 10**3, 10**6, 10**9)
_NEXT_TO_HALF = 2.0**-20
_SAMPLE = 64


class Projected(NamedTuple):
    """Image coordinates, and whether the point lies behind the camera (p_z < 0)."""

    x: Result
    y: Result
    behind: Any


def _project(f: Any, x: Any, y: Any, z: Any) -> Any:
    return f * x / z, f * y / z


def _project_short(f: Any, x: Any, y: Any, z: Any, x_i: Any, y_i: Any) -> None:
    """f/z first: it is neither huge nor tiny, so only the results round."""
    scale = f / z
    np.multiply(x, scale, out=x_i)
    np.multiply(y, scale, out=y_i)


_PROJECT = Kernel(
    lambda *args: (_project(*args), None),
    (POSITIVE, REAL, REAL, REAL),
    (
        Rule(
            "on-camera-plane",
            lambda _f, _x, _y, z: z == 0,
            lambda _f, _x, _y, z: z[0] <= 0 <= z[1],
        ),
    ),
    exact=_project,
    reach=2.0**300,
    outputs=2,
    fast=_project_short,
    watched=(0, 3),
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
    x, y = _PROJECT(f, p_x, p_y, p_z)
    return Projected(x, y, behind(p_z))


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
    value = _pixel(*pairs(f, pitch, x, z, o)).rounded()
    twice = 2 * value
    cancelled = np.abs(value) < np.abs(value - o)
    return value, cancelled | (np.abs(twice - np.rint(twice)) < _NEXT_TO_HALF)


def _by_integers(camera: Sequence[float], x: Array, z: Array, out: Array) -> bool:
    """One quotient of exactly known integers; false if they are too long or z is not one sign."""
    f, pitch, o = camera
    scaled_x, scaled_z = _integers(x), _integers(z)
    if scaled_x is None or scaled_z is None:
        return False
    (x, by_x), (z, by_z) = scaled_x, scaled_z
    of_z, of_x, below = _factors(f, pitch, o, by_x, by_z)
    widest = max(float(x.max()), -float(x.min()))
    nearest, farthest = float(z.min()), float(z.max())
    deepest = max(farthest, -nearest)
    if max(abs(of_z) * deepest + of_x * widest, below * deepest) >= _LARGEST:
        return False
    np.multiply(z, float(of_z), out=out)
    x *= float(of_x)
    out += x
    if below != 1:
        z *= float(below)
    out /= z
    return nearest > 0 or farthest < 0


@lru_cache(maxsize=64)
def _factors(f: float, pitch: float, o: float, by_x: int, by_z: int) -> tuple[int, int, int]:
    """Integers a, b, c with u = (a z + b x)/(c z) for whole x and z."""
    g, start = Fraction(repr(f)) / Fraction(repr(pitch)), Fraction(repr(o))
    factors = (
        start.numerator * g.denominator * by_x,
        start.denominator * g.numerator * by_z,
        start.denominator * g.denominator * by_x,
    )
    common = math.gcd(*factors)
    a, b, c = (factor // common for factor in factors)
    return a, b, c


def _integers(values: Array) -> tuple[Array, int] | None:
    """Integers m and a power of ten with values = m/10**k, all read as decimals."""
    few = values[:_SAMPLE]
    for scale in _SCALES:
        if (np.rint(few * scale) / scale == few).all():
            whole = values * float(scale)
            np.rint(whole, out=whole)
            if ((whole / float(scale) if scale > 1 else whole) == values).all():
                return whole, scale
    return None


def _by_blocks(f: Numbers, pitch: Numbers, x: Numbers, z: Numbers, o: Numbers) -> Array | None:
    """The short decimals of an exam, or None when anything needs a closer look."""
    if any(np.ndim(arg) for arg in (f, pitch, o)) or np.ndim(x) == 0 or np.shape(x) != np.shape(z):
        return None
    camera = [float(np.asarray(arg, dtype=np.float64)) for arg in (f, pitch, o)]
    if not (all(map(math.isfinite, camera)) and camera[0] > 0 and camera[1] > 0):
        return None
    columns = [np.asarray(arg, dtype=np.float64).reshape(-1) for arg in (x, z)]
    out = np.empty(columns[0].size)
    for start in range(0, out.size, WIDE_BLOCK):
        across, depth = (column[start : start + WIDE_BLOCK] for column in columns)
        if not _by_integers(camera, across, depth, out[start : start + WIDE_BLOCK]):
            return None
    return out.reshape(np.shape(x))


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
    with np.errstate(all="ignore"):
        short = _by_blocks(f, pitch, x, z, o)
    return _PIXEL(f, pitch, x, z, o) if short is None else short


_PIXEL_SCALAR = Kernel(
    lambda *_args: (np.zeros(1), np.ones(1, dtype=bool)),
    _PIXEL.spans,
    _PIXEL.rules,
    exact=_decimal_pixel,
)


def _pixel_scalar(*args: Any) -> float:
    result: float = _PIXEL_SCALAR(*args)
    return result
