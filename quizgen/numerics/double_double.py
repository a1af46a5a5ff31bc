"""Numbers of twice the working precision on arrays: an unevaluated sum of two doubles.

Formulas written with ``+ - * /`` run unchanged on ``Pair`` arrays, good to about 2**-100, and on
fractions, which are exact and decide the doubtful rest.

Sources: Dekker, Numer. Math. 18 (1971) 224; Knuth, TAOCP 2, 4.2.2. NumPy has no fused
multiply-add, so products are split. Operands must stay within 1e-140 .. 1e140 or be zero.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from quizgen.numerics.typing import Array

Double = float | Array
"""One double, or a block of them."""

_SPLITTER = 134217729.0
"""2**27 + 1 splits a double into two halves of 26 bits."""


def two_sum(a: Double, b: Double) -> tuple[Any, Any]:
    """Sum of two doubles and its rounding error, exactly."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


def split_double(a: Double) -> tuple[Any, Any]:
    """Upper and lower half of a double, exactly."""
    c = a * _SPLITTER
    high = c - a
    high = np.subtract(c, high, out=high) if isinstance(high, np.ndarray) else c - high
    return high, a - high


def two_product(a: Double, b: Double) -> tuple[Any, Any]:
    """Product of two doubles and its rounding error, exactly."""
    return _multiply_halves(a, split_double(a), b, split_double(b))


def _multiply_halves(
    a: Double, a_halves: tuple[Double, Double], b: Double, b_halves: tuple[Double, Double]
) -> tuple[Any, Any]:
    p = a * b
    a_high, a_low = a_halves
    b_high, b_low = b_halves
    e = a_high * b_high
    e -= p
    t = a_high * b_low
    if not isinstance(t, np.ndarray):
        return p, ((e + t) + a_low * b_high) + a_low * b_low
    e += t
    e += np.multiply(a_low, b_high, out=t)
    e += np.multiply(a_low, b_low, out=t)
    return p, e


class DoubleDouble:
    """The unevaluated sum ``high + low`` of two arrays; ``low`` is None when it is zero."""

    __slots__ = ("_halves", "high", "low")
    __array_ufunc__ = None  # arrays leave mixed operations to this class

    high: Any
    low: Any

    def __init__(self, high: Double, low: Double | None = None) -> None:
        self.high = high
        self.low = low
        self._halves: Any = None

    @property
    def halves(self) -> Any:
        """The split of ``high``, made once."""
        if self._halves is None:
            self._halves = split_double(self.high)
        return self._halves

    def round_to_double(self) -> Array:
        """The nearest double (up to 2**-100)."""
        result = self.high if self.low is None else self.high + self.low
        return np.asarray(result, dtype=np.float64)

    def __add__(self, other: Operand) -> DoubleDouble:
        """Sum; the error is small against the larger operand, not against a cancelled result."""
        other = as_pair(other)
        s, e = two_sum(self.high, other.high)
        if self.low is None and other.low is None:
            return DoubleDouble(s, e)
        for low in (self.low, other.low):
            if low is not None:
                e = e + low
        return _normalise_pair(s, e)

    __radd__ = __add__

    def __neg__(self) -> DoubleDouble:
        """Opposite number."""
        return DoubleDouble(-self.high, None if self.low is None else -self.low)

    def __sub__(self, other: Operand) -> DoubleDouble:
        """Difference, as the sum."""
        return self + (-as_pair(other))

    def __rsub__(self, other: Operand) -> DoubleDouble:
        """Difference, as the sum."""
        return as_pair(other) + (-self)

    def __mul__(self, other: Operand) -> DoubleDouble:
        """Product."""
        other = as_pair(other)
        p, e = _multiply_halves(self.high, self.halves, other.high, other.halves)
        if other.low is not None:
            e = e + self.high * other.low
        if self.low is not None:
            e = e + self.low * other.high
        return DoubleDouble(p, e)

    __rmul__ = __mul__

    def __truediv__(self, other: Operand) -> DoubleDouble:
        """Quotient: one division and one correction from the exact remainder."""
        other = as_pair(other)
        q = self.high / other.high
        p, e = _multiply_halves(q, split_double(q), other.high, other.halves)
        rest = (self.high - p) - e
        if self.low is not None:
            rest = rest + self.low
        if other.low is not None:
            rest = rest - q * other.low
        return DoubleDouble(q, rest / other.high)

    def __rtruediv__(self, other: Operand) -> DoubleDouble:
        """Quotient."""
        return as_pair(other) / self


Operand = DoubleDouble | Double


def _normalise_pair(s: Double, e: Double) -> DoubleDouble:
    high = s + e
    return DoubleDouble(high, e - (high - s))


def as_pair(value: Operand) -> DoubleDouble:
    """Wrap a number or an array."""
    return value if isinstance(value, DoubleDouble) else DoubleDouble(value)


def as_pairs(*values: Double) -> tuple[DoubleDouble, ...]:
    """Wrap several."""
    return tuple(DoubleDouble(value) for value in values)


Exponent = tuple[float, float]
"""An exponent and what rounding it lost."""

_UNIT = 2.0**-53
_LEAST = 5e-324


def power_with_remainder(x: Array, exponent: Exponent) -> Array:
    """Raise to a power with the exponent carried to twice the working precision."""
    high, low = exponent
    y: Array = x**high
    least = x.min()
    if low == 0 or (least > 0 and abs(low) * max(-math.log(least), math.log(x.max())) < _UNIT):
        return y
    y *= 1 + low * np.log(np.maximum(x, _LEAST))
    return y


def split_exponent(exponent: Fraction) -> Exponent:
    """Nearest double of an exponent, and what that lost."""
    high = float(exponent)
    return high, float(exponent - Fraction(high))


def evaluate_polynomial(coefficients: Sequence[float], x: Array) -> Array:
    """Polynomial with at least two coefficients in ascending order."""
    *rest, second, last = coefficients
    total = x * last
    total += second
    for c in reversed(rest):
        total *= x
        total += c
    return total
