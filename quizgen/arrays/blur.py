"""Blur disc (circle of confusion) of a thin lens.

Source: c = D |z'_s - z'_p| / z'_p with D = f/N and both image distances eliminated, which
removes the cancellation near the plane of focus.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from quizgen.arrays.aliases import Array, Flags, Numbers, Result
from quizgen.arrays.domain import POSITIVE, Rule
from quizgen.arrays.double_double import Number, pairs
from quizgen.arrays.kernel import Exactly, Kernel, Short, filled


def _formula(f: Number, N: Number, s: Number, z: Number) -> Number:
    return f * f * abs(z - s) / (N * (s - f) * z)


def _compute(f: Array, N: Array, s: Array, z: Array) -> tuple[Array, Flags]:
    return _formula(*pairs(f, N, s, z)).rounded(), s == f


def _short(f: Array, N: Array, s: Array, z: Array) -> Array:
    """Seven roundings and no cancellation; s = f is left to infinity."""
    value = (f / N) * (f / (s - f)) * (np.abs(z - s) / z)
    return np.where(np.isnan(value), 0.0, value) if np.isnan(value.max()) else value


def _exact(f: Fraction, N: Fraction, s: Fraction, z: Fraction) -> Fraction | float:
    if s == f:
        return 0.0 if z == s else math.inf
    return _formula(f, N, s, z)


_BLUR = Kernel(
    _compute,
    (POSITIVE,) * 4,
    rules=(
        Rule(
            "no-real-image",
            lambda f, _N, s, _z: s < f,
            lambda f, _N, s, _z: s[0] < f[1],
        ),
    ),
    exact=Exactly(_exact),
    short=Short(filled(_short)),
)


def blur_disc(f: Numbers, N: Numbers, s: Numbers, z: Numbers) -> Result:
    """Diameter of the blur disc of a point, c = (f/N) (f/(s - f)) |z - s|/z.

    Parameters
    ----------
    f : array_like
        Focal length, > 0.
    N : array_like
        f-number, > 0.
    s : array_like
        Distance in focus, >= f.
    z : array_like
        Distance of the point, > 0 (closer than f is allowed: its rays still diverge).

    Returns
    -------
    float or array
        Unit of f, s and z; 0 in the plane of focus, infinity for s = f.

    Raises
    ------
    DomainError
        ``no-real-image`` (s < f).
    """
    return _BLUR(f, N, s, z)
