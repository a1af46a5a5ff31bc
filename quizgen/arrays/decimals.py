"""Doubles read as the decimals they stand for.

A double that is the nearest to a decimal of at most fifteen digits is read as this decimal; no
two of them share a double. Every other double (1/3, 0.1 + 0.2, most points of a linspace) is
read as itself.

Source: Matula, "In-and-out conversions", Comm. ACM 11 (1968) 47.
"""

from __future__ import annotations

import math
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from quizgen.arrays.aliases import Array
from quizgen.arrays.double_double import Pair, two_product
from quizgen.arrays.rational import nearest

_DIGITS = 15
_LARGEST = 10.0**_DIGITS
_SMALLEST = 1e-8
"""From here to _LARGEST fifteen digits are a whole number over an exactly known power of ten."""

_POWERS = np.array([float(f"1e{e}") for e in range(-7, _DIGITS + 1)])
_SCALES = np.array([float(f"1e{e}") for e in range(22, -2, -1)])
_PLACES = (1, 10, 10**3, 10**6, 10**9)
_SAMPLE = 64


@lru_cache(maxsize=256)
def read(value: float) -> Fraction:
    """Read one double."""
    text = repr(value)
    digits = Decimal(text).normalize().as_tuple().digits
    return Fraction(text) if len(digits) <= _DIGITS else Fraction(value)


def as_pair(values: Array) -> Pair:
    """Read doubles as numbers of twice the working precision."""
    size = np.abs(values)
    scale = _SCALES[np.searchsorted(_POWERS, size, side="right")]
    m = np.rint(values * scale)
    p, e = two_product(values, scale)
    low = np.where(m / scale == values, ((m - p) - e) / scale, 0.0)
    for i in np.flatnonzero(((size < _SMALLEST) & (size > 0)) | (size >= _LARGEST)):
        value = float(values[i])
        low[i] = nearest(read(value) - Fraction(value))
    return Pair(values, low)


class Whole(NamedTuple):
    """A block read as ``number * m / scale``, all exact integers.

    A block that is one number for all has no ``m``.
    """

    number: int
    m: Array | None
    scale: int
    low: float
    high: float

    @property
    def size(self) -> float:
        """Largest magnitude of ``m``."""
        return 1.0 if self.m is None else max(self.high, -self.low)


class Reader:
    """Reads the blocks of one argument as integers; neighbours mostly have as many places."""

    def __init__(self) -> None:
        self._places = 1
        self._number: Whole | None = None

    def __call__(self, values: Array) -> Whole | None:
        """Read a block, or give None when a value has more than nine places or 15 digits."""
        if values.size == 1:
            return self._read_number(float(values[0]))
        m = _integers(values, self._places)
        if m is None:
            self._places = _places(values[:_SAMPLE])
            m = _integers(values, self._places)
        if m is None:
            return None
        low, high = float(m.min()), float(m.max())
        return Whole(1, m, self._places, low, high) if max(high, -low) < _LARGEST else None

    def _read_number(self, value: float) -> Whole | None:
        if not math.isfinite(value):
            return None
        if self._number is None or self._number.low != value:
            exact = read(value)
            self._number = Whole(exact.numerator, None, exact.denominator, value, value)
        return self._number


def _places(few: Array) -> int:
    return next((s for s in _PLACES if (np.rint(few * s) / s == few).all()), _PLACES[-1])


def _integers(values: Array, scale: int) -> Array | None:
    """Integers m so that the values are the nearest doubles to m/scale."""
    if scale == 1:
        m = np.rint(values)
        return m if (m == values).all() else None
    m = values * float(scale)
    np.rint(m, out=m)
    return m if (m / float(scale) == values).all() else None
