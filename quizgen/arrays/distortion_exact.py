"""Exact decisions and roots for the few elements next to the fold or of extreme size.

The fold radius is irrational, so it is enclosed to 400 bits; monotone bisection over doubles then
finds the nearest one. Slow (a millisecond each) and safe.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from quizgen.arrays.aliases import Array, Flags
from quizgen.arrays.rational import exactly, nearest

_BITS = 400


def _root(value: Fraction) -> Fraction:
    """Square root to 400 bits."""
    shift = max(0, value.denominator.bit_length() - value.numerator.bit_length()) + 2 * _BITS
    shift += shift % 2
    scaled = (value.numerator << shift) // value.denominator
    return Fraction(math.isqrt(scaled), 1 << (shift // 2))


def _fold(k1: Fraction, k2: Fraction) -> Fraction | None:
    """Fold radius, or None when the distorted radius grows for ever."""
    if k2 == 0:
        return _root(-1 / (3 * k1)) if k1 < 0 else None
    inside = 9 * k1 * k1 - 20 * k2
    if inside < 0 or (k1 >= 0 and k2 > 0):
        return None
    root = _root(inside)
    u = 2 / (root - 3 * k1) if k1 < 0 else (3 * k1 + root) / (-10 * k2)
    return _root(u)


def _distorted(r: Fraction, k1: Fraction, k2: Fraction) -> Fraction:
    r2 = r * r
    return r * (1 + r2 * (k1 + k2 * r2))


def fold_exactly(k1: Fraction, k2: Fraction) -> Fraction | float:
    """Fold radius, or infinity."""
    fold = _fold(k1, k2)
    return math.inf if fold is None else fold


def beyond_exactly(beyond: Flags, unsure: Flags, args: tuple[Array, ...]) -> Flags:
    """Decide the unsure elements."""
    size = max(arg.size for arg in args)
    result = np.array(np.broadcast_to(beyond, (size,)))
    for i in np.flatnonzero(np.broadcast_to(unsure, (size,))):
        r_d, k1, k2 = exactly(args, i)
        fold = _fold(k1, k2)
        result[i] = fold is not None and r_d > _distorted(fold, k1, k2)
    return result


def invert_exactly(r_d: Fraction, k1: Fraction, k2: Fraction) -> Fraction:
    """The double nearest to the undistorted radius, and two bits more, by bisection.

    The search runs over doubles first and halves the last interval a few times more, so that
    differences with r_d keep their leading digits.
    """
    if r_d == 0:
        return r_d
    fold = _fold(k1, k2)
    low, high = Fraction(0), _ceiling(r_d, k1, k2) if fold is None else fold
    low, high = _by_doubles(r_d, k1, k2, high)
    for _ in range(120):
        middle = (low + high) / 2
        if _distorted(middle, k1, k2) < r_d:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def _by_doubles(
    r_d: Fraction, k1: Fraction, k2: Fraction, high: Fraction
) -> tuple[Fraction, Fraction]:
    """Bracket between two neighbouring doubles, by bisection over their bit patterns."""
    first, last = 0, int(np.float64(min(nearest(high), 1.7e308)).view(np.int64))
    while last - first > 1:
        middle = (first + last) // 2
        r = Fraction(float(np.int64(middle).view(np.float64)))
        if r < high and _distorted(r, k1, k2) < r_d:
            first = middle
        else:
            last = middle
    low = Fraction(float(np.int64(first).view(np.float64)))
    return low, min(high, Fraction(float(np.int64(last).view(np.float64))))


def _ceiling(r_d: Fraction, k1: Fraction, k2: Fraction) -> Fraction:
    """A radius that certainly maps beyond r_d when there is no fold."""
    high = r_d
    while _distorted(high, k1, k2) < r_d:
        high *= 2
    return high
