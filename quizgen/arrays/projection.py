"""Pinhole projection and pixel coordinates.

Sources: x = f p_x/p_z; u = o + f p_x/(pitch p_z). Pixel coordinates read their arguments as
decimals, because an integer answer is then an integer (2 mm, 5 um, -1, 2 and offset 320 give
120, where doubles alone give 119.99999999999997).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from quizgen.arrays.aliases import Array, Flags, Numbers, Result
from quizgen.arrays.decimals import Reader, Whole, as_pair, read
from quizgen.arrays.domain import POSITIVE, REAL, Rule
from quizgen.arrays.double_double import Number
from quizgen.arrays.kernel import Exactly, Kernel, Short, in_short_blocks

_LARGEST = 2.0**53
_CANCELLED = 2.0**-40


class Projected(NamedTuple):
    """Image coordinates, and whether the point lies behind the camera (p_z < 0)."""

    x: Result
    y: Result
    behind: bool | Flags


def _project(f: Number, x: Number, y: Number, z: Number) -> tuple[Number, Number]:
    return f * x / z, f * y / z


def _project_short(f: Array, x: Array, y: Array, z: Array, x_i: Array, y_i: Array) -> None:
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
    exact=Exactly(_project, 2.0**300),
    short=Short(_project_short, 2.0**300, watched=(0, 3)),
    outputs=2,
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
        ``on-camera-plane`` (p_z = 0).
    """
    x, y = _PROJECT(f, p_x, p_y, p_z)
    return Projected(x, y, behind(p_z))


def behind(p_z: Numbers) -> bool | Flags:
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


def _pixel(f: Number, pitch: Number, x: Number, z: Number, o: Number) -> Number:
    return o + f * x / (pitch * z)


def _exact_pixel(*args: Fraction) -> Fraction:
    result: Fraction = _pixel(*[read(float(arg)) for arg in args])
    return result


def _pixels(*args: Array) -> tuple[Array, Flags | None]:
    out = np.empty(max(arg.size for arg in args))
    if _by_integers([Reader() for _ in args], args, out):
        return out, None
    f, pitch, x, z, o = map(as_pair, args)
    value = _pixel(f, pitch, x, z, o).rounded()
    return value, np.abs(value) < _CANCELLED * np.abs(o.high)


def _by_integers(readers: Sequence[Reader], blocks: Sequence[Array], out: Array) -> bool:
    """One quotient of exactly known integers; false if they are too long or an answer misses."""
    wholes = [w for reader, block in zip(readers, blocks, strict=True) if (w := reader(block))]
    if len(wholes) < len(readers):
        return False
    f, pitch, x, z, o = wholes
    on_plane = z.low <= 0 <= z.high and (z.m is None or not z.m.all())
    if f.low <= 0 or pitch.low <= 0 or on_plane:
        return False
    a, b, c = _factors(f, pitch, x, z, o)
    depth, width = pitch.size * z.size, f.size * x.size
    if max(abs(a) * o.size * depth + abs(b) * width, abs(c) * depth) >= _LARGEST:
        return False
    below, above = _product(pitch, z), _product(f, x)
    if o.m is None:
        np.multiply(below, float(a), out=out)
    else:
        np.multiply(below, o.m, out=out)
        _scale_up(out, a)
    out += _scale_up(above, b)
    out /= _scale_up(below, c)
    return True


def _factors(f: Whole, pitch: Whole, x: Whole, z: Whole, o: Whole) -> tuple[int, int, int]:
    """Integers with u = (a o pitch z + b f x)/(c pitch z), the letters standing for ``m``."""
    depth = pitch.number * z.number * f.scale * x.scale
    factors = (
        o.number * depth,
        f.number * x.number * pitch.scale * z.scale * o.scale,
        o.scale * depth,
    )
    common = math.gcd(*factors)
    a, b, c = (factor // common for factor in factors)
    return a, b, c


def _product(one: Whole, other: Whole) -> Array:
    """The product of what varies; overwrites its blocks."""
    if one.m is None or other.m is None:
        only = one.m if other.m is None else other.m
        return np.ones(1) if only is None else only
    return np.multiply(one.m, other.m, out=one.m)


def _scale_up(values: Array, factor: int) -> Array:
    if factor != 1:
        values *= float(factor)
    return values


_PIXEL = Kernel(
    _pixels,
    (POSITIVE, POSITIVE, REAL, REAL, REAL),
    (Rule("on-camera-plane", lambda _f, _pitch, _x, z, _o: z == 0),),
    exact=Exactly(_exact_pixel),
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
        Pixels, correctly rounded (in arrays up to 2**-90 next to ties). Doubles that name a
        decimal of at most fifteen digits are read as it: 0.1 is one tenth (see ``decimals``).
        Arrays are fastest when no decimal has more than nine places.

    Raises
    ------
    DomainError
        ``on-camera-plane`` (z = 0).
    """
    if all(np.ndim(arg) == 0 for arg in (f, pitch, x, z, o)):
        return _pixel_scalar(f, pitch, x, z, o)
    readers = [Reader() for _ in range(5)]
    return in_short_blocks(
        lambda *blocks: _by_integers(readers, blocks[:-1], blocks[-1]), _PIXEL, f, pitch, x, z, o
    )


_PIXEL_SCALAR = Kernel(
    lambda *_args: (np.zeros(1), np.ones(1, dtype=bool)),
    _PIXEL.spans,
    _PIXEL.rules,
    exact=Exactly(_exact_pixel),
)


def _pixel_scalar(*args: Numbers) -> float:
    result: float = _PIXEL_SCALAR(*args)
    return result
