"""How the gap enc(mean) - mean(enc) is computed, on blocks of ordinary arrays.

With m the mean and d = |b - a|/(a + b) it is m**e g(d**2),
g(q) = 1 - ((1 + d)**e + (1 - d)**e)/2: a polynomial in q = d**2 while d is not close to 1.
"""

from __future__ import annotations

import decimal
import math
import operator
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from .domain import Array
from .double_double import SPLITTER, Pair, split, two_difference, two_sum
from .power import halves, raised

_TOE = 2.0**-900
REACH = 2.0**400
"""Squares of values from 1/REACH to REACH neither overflow nor underflow."""

_SERIES = 0.55
_SHIFTED = 0.85
_CENTRE = 0.5125
_MIDST = 0.925
_DIGITS = decimal.Context(prec=60)

Exactly = Callable[[decimal.Decimal], decimal.Decimal]


def _interpolate(function: Exactly, low: float, high: float, centre: float, count: int) -> Any:
    """Coefficients, in powers of x - centre, of the polynomial through Chebyshev points."""
    middle, half = (low + high) / 2, (high - low) / 2
    angles = (math.pi * (i + 0.5) / count for i in range(count))
    nodes = [decimal.Decimal(middle + half * math.cos(angle)) for angle in angles]
    table = [function(node) for node in nodes]
    for order in range(1, count):  # divided differences
        for i in range(count - 1, order - 1, -1):
            rise = _DIGITS.subtract(table[i], table[i - 1])
            table[i] = _DIGITS.divide(rise, _DIGITS.subtract(nodes[i], nodes[i - order]))
    result = [Fraction(0)] * count
    for value, node in zip(reversed(table), reversed(nodes), strict=True):
        shift = Fraction(centre) - Fraction(node)
        shifted = [shift * c for c in result]
        result = [shifted[0] + Fraction(value), *map(operator.add, shifted[1:], result)]
    return result


def _direct(e: Fraction) -> tuple[Exactly, Exactly, Exactly]:
    """g(q)/q, g(q) and 1 - (1 + d)**e/2 in sixty-digit decimals."""
    exponent = _DIGITS.divide(*map(decimal.Decimal, e.as_integer_ratio()))

    def power(x: decimal.Decimal) -> decimal.Decimal:
        return _DIGITS.power(x, exponent)

    def gap_of(q: decimal.Decimal) -> decimal.Decimal:
        d = _DIGITS.sqrt(q)
        pair = power(_DIGITS.add(1, d)), power(_DIGITS.subtract(1, d))
        return _DIGITS.subtract(1, _DIGITS.divide(_DIGITS.add(*pair), 2))

    def smooth(d: decimal.Decimal) -> decimal.Decimal:
        return _DIGITS.subtract(1, _DIGITS.divide(power(_DIGITS.add(1, d)), 2))

    return (lambda q: _DIGITS.divide(gap_of(q), q)), gap_of, smooth


def _horner(coefficients: Sequence[float], x: Array) -> Array:
    *rest, second, last = coefficients
    total = x * last
    total += second
    for c in reversed(rest):
        total *= x
        total += c
    return total


def _short_quotient(top: Pair, below: Pair) -> Pair:
    """Quotient with a higher half of 26 bits: products with it, and its square, are exact."""
    inverse = 1 / below.high  # the lower half makes up for all of its error
    rough = top.high * inverse
    high = rough * SPLITTER
    np.subtract(high, rough, out=rough)
    high -= rough
    upper, lower = split(below.high)
    upper *= high
    np.subtract(top.high, upper, out=upper)
    lower *= high
    upper -= lower
    upper += top.low
    np.multiply(high, below.low, out=lower)
    upper -= lower
    upper *= inverse
    return Pair(high, upper)


def _short_square(d: Pair) -> Pair:
    """Square of such a quotient."""
    exact = d.high * d.high
    rest = 2 * d.high
    rest += d.low
    rest *= d.low
    high = exact + rest
    exact -= high
    exact += rest
    return Pair(high, exact)


class Gap:
    """The gap for one exponent, with its coefficients."""

    def __init__(self, e: Fraction) -> None:
        self.fraction = e
        self.exponent = halves(e)
        over_q, of_q, smooth = _direct(e)
        first, *rest = _interpolate(over_q, 0.0, _SERIES**2, 0.0, 15)
        self.start, self.series = Pair(*halves(first)), [float(c) for c in rest]
        first, *rest = _interpolate(of_q, _SERIES**2, _SHIFTED**2, _CENTRE, 25)
        self.around_start, self.around = Pair(*halves(first)), [float(c) for c in rest]
        first, *rest = _interpolate(smooth, _SHIFTED, 1.0, _MIDST, 13)
        self.smooth_start, self.smooth = Pair(*halves(first)), [float(c) for c in rest]

    def __call__(self, a: Array, b: Array) -> Array:
        """Keep sums and products away from overflow and underflow by a power of two."""
        top = np.maximum(a, b)
        if top.max() <= REACH and top.min() >= 1 / REACH:
            return self.moderate(a, b)
        shift = np.frexp(top)[1]
        return self.moderate(np.ldexp(a, -shift), np.ldexp(b, -shift)) * self.scale(shift)

    def scale(self, shift: Any) -> Any:
        """2**(e shift), split so that the exponent stays exact."""
        turns = [divmod(int(s) * self.fraction, 1) for s in shift]
        roots = [2.0 ** float(rest) for _, rest in turns]
        return np.ldexp(roots, [int(whole) for whole, _ in turns])

    def moderate(self, a: Array, b: Array) -> Array:
        """The gap for values whose square neither overflows nor underflows."""
        total = Pair(*two_sum(a, b))
        if total.high.min() == 0:
            total.high = np.maximum(total.high, _TOE)
        d = _short_quotient(Pair(*two_difference(b, a)), total)
        shape, rest = self.shape(d)
        total.low /= total.high
        total.low *= self.exponent[0]
        total.low *= shape
        rest += total.low
        total.high *= 0.5
        power = raised(total.high, self.exponent)
        shape *= power
        rest *= power
        shape += rest
        return shape

    def shape(self, d: Pair) -> tuple[Array, Array]:
        """The function g of the relative difference, piece by piece."""
        q = _short_square(d)
        size = np.abs(d.high)
        small, wide = size <= _SERIES, size > _SHIFTED
        shape, rest = np.empty_like(size), np.empty_like(size)
        for piece, argument, flags in (
            (self.small, q, small),
            (self.middle, q, ~(small | wide)),
            (self.wide, d, wide),
        ):
            where = np.flatnonzero(flags)
            if where.size:
                found = piece(Pair(argument.high.take(where), argument.low.take(where)))
                shape[where], rest[where] = found.high, found.low
        return shape, rest

    def small(self, q: Pair) -> Pair:
        """The product q (c0 + t); only its own rounding is not kept in the lower half."""
        t = _horner(self.series, q.high)
        t *= q.high
        factor = t + self.start.high
        low = self.start.high - factor
        low += t
        low += self.start.low
        low *= q.high
        q.low *= factor
        low += q.low
        factor *= q.high
        return Pair(factor, low)

    def middle(self, q: Pair) -> Pair:
        """The polynomial around _CENTRE."""
        x = q.high - _CENTRE
        x += q.low
        t = _horner(self.around, x)
        t *= x
        high, low = two_sum(self.around_start.high, t)
        low += self.around_start.low
        return Pair(high, low)

    def wide(self, d: Pair) -> Pair:
        """With (1 - d)**e from the power function; the rest is smooth next to d = 1."""
        sign = np.where(d.high < 0, -1.0, 1.0)
        d = Pair(d.high * sign, d.low * sign)
        x = (d.high - _MIDST) + d.low
        smooth, error = two_sum(self.smooth_start.high, x * _horner(self.smooth, x))
        left, below = two_sum(1 - d.high, -d.low)
        power = raised(left, self.exponent)
        lost = power * (self.exponent[0] * (below / np.maximum(left, _TOE)))
        return Pair(smooth - power / 2, error + self.smooth_start.low - lost / 2)
