"""Numbers of twice the working precision on arrays: an unevaluated sum of two doubles.

Formulas written with ``+ - * /`` run unchanged on `DoubleDouble`, good to about 2**-100, and on
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

from quizgen.numerics.domain import Array

Double = float | Array
"""One double, or a block of them."""

_SPLITTER = 134217729.0
"""2**27 + 1 splits a double into two halves of 26 bits."""


def two_sum(a: Double, b: Double) -> tuple[Any, Any]:
    """Return the rounded sum of two doubles and its rounding error: together they are exact."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


def split_double(a: Double) -> tuple[Any, Any]:
    """Return two halves of a double of 26 bits each, whose sum it is exactly.

    Products of halves are exact, which stands for a fused multiply-add.
    """
    c = a * _SPLITTER
    high = c - a
    high = np.subtract(c, high, out=high) if isinstance(high, np.ndarray) else c - high
    return high, a - high


def two_product(a: Double, b: Double) -> tuple[Any, Any]:
    """Return the rounded product of two doubles and its rounding error: together they are exact."""
    return _multiply_halves(a, split_double(a), b, split_double(b))


def _multiply_halves(
    a: Double, a_halves: tuple[Double, Double], b: Double, b_halves: tuple[Double, Double]
) -> tuple[Any, Any]:
    """Return what `two_product` does, from halves of both factors that were split before."""
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
        """The two halves of ``high``, split when first needed."""
        if self._halves is None:
            self._halves = split_double(self.high)
        return self._halves

    def round_to_double(self) -> Array:
        """Return the nearest double, up to a relative 2**-100."""
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
        """Product, to about 2**-100."""
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
        """Quotient with a double or an array above the line."""
        return as_pair(other) / self


Operand = DoubleDouble | Double


def _normalise_pair(s: Double, e: Double) -> DoubleDouble:
    """Return s + e as a pair whose low part is below half a last place of the high one."""
    high = s + e
    return DoubleDouble(high, e - (high - s))


def as_pair(value: Operand) -> DoubleDouble:
    """Return a number or an array as a `DoubleDouble`; one that is a pair already stays."""
    return value if isinstance(value, DoubleDouble) else DoubleDouble(value)


def as_pairs(*values: Double) -> tuple[DoubleDouble, ...]:
    """Return several numbers or arrays as `DoubleDouble` each."""
    return tuple(DoubleDouble(value) for value in values)


Exponent = tuple[float, float]
"""An exponent and what rounding it lost."""

_UNIT = 2.0**-53
_LEAST = 5e-324


def power_with_remainder(x: Array, exponent: Exponent) -> Array:
    """Return x**(high + low) for x >= 0, the exponent carried to twice the working precision."""
    high, low = exponent
    y: Array = x**high
    least = x.min()
    if low == 0 or (least > 0 and abs(low) * max(-math.log(least), math.log(x.max())) < _UNIT):
        return y
    y *= 1 + low * np.log(np.maximum(x, _LEAST))
    return y


def split_exponent(exponent: Fraction) -> Exponent:
    """Return the nearest double of an exponent, and the difference that rounding lost."""
    high = float(exponent)
    return high, float(exponent - Fraction(high))


def evaluate_polynomial(coefficients: Sequence[float], x: Array) -> Array:
    """Return a polynomial in x by Horner's rule; at least two coefficients, in ascending order."""
    *rest, second, last = coefficients
    total = x * last
    total += second
    for c in reversed(rest):
        total *= x
        total += c
    return total
