"""How the gap enc(mean) - mean(enc) is computed, on blocks of ordinary arrays.

With m the mean and d = |b - a|/(a + b) it is m**e g(d**2),
g(q) = 1 - ((1 + d)**e + (1 - d)**e)/2, q = d**2. While d is not close to 1, g/q is a polynomial in
w = q/(1 - _BEND q): g is singular for q >= 1, and this keeps w as far from there as it can be.
"""

from __future__ import annotations

import decimal
import math
import operator
from collections.abc import Callable
from fractions import Fraction

import numpy as np

from quizgen.arrays.aliases import Array, Counts
from quizgen.arrays.double_double import SPLITTER, Pair, split, two_difference, two_sum
from quizgen.arrays.kernel import lowest
from quizgen.arrays.logarithm import LN2, log_pair
from quizgen.arrays.polynomial import horner
from quizgen.arrays.power import halves, raised

_TOE = 2.0**-900
_SLOW = 0.1
_REACH = 2.0**400
"""Squares of values from its inverse to it neither overflow nor underflow."""

_WIDE = 0.85
"""From this d on, (1 - d)**e is computed as a power."""

_FLAT, _STEEP = 0.27, 0.75
_BEND = 0.65625
_CENTRE = _WIDE**2 / (1 - _BEND * _WIDE**2) / 2
_MIDST = (_WIDE + 1) / 2
_DIGITS = decimal.Context(prec=60)

Exactly = Callable[[decimal.Decimal], decimal.Decimal]


def _interpolate(
    function: Exactly, low: float, high: float, centre: float, count: int
) -> list[Fraction]:
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


def _left_out(e: Fraction) -> tuple[int, int]:
    """Which line k + m x to take from x**e, so that g is no small difference for e near 0 or 1."""
    return int(e < _FLAT), int(e > _STEEP)


def _direct(e: Fraction) -> tuple[Exactly, Exactly]:
    """g(q)/q in terms of w, and g + (x**e - k - m x)/2 for x = 1 - d, in sixty-digit decimals."""
    exponent = _DIGITS.divide(*map(decimal.Decimal, e.as_integer_ratio()))
    bend = decimal.Decimal(_BEND)
    constant, slope = _left_out(e)

    def power(x: decimal.Decimal) -> decimal.Decimal:
        return _DIGITS.power(x, exponent)

    def over_q(w: decimal.Decimal) -> decimal.Decimal:
        q = _DIGITS.divide(w, _DIGITS.fma(bend, w, 1))
        d = _DIGITS.sqrt(q)
        pair = power(_DIGITS.add(1, d)), power(_DIGITS.subtract(1, d))
        return _DIGITS.divide(_DIGITS.subtract(1, _DIGITS.divide(_DIGITS.add(*pair), 2)), q)

    def smooth(d: decimal.Decimal) -> decimal.Decimal:
        kept = _DIGITS.fma(slope, _DIGITS.subtract(1, d), constant)
        return _DIGITS.subtract(1, _DIGITS.divide(_DIGITS.add(power(_DIGITS.add(1, d)), kept), 2))

    return over_q, smooth


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
        over_q, smooth = _direct(e)
        first, *rest = _interpolate(over_q, 0.0, 2 * _CENTRE, _CENTRE, 19)
        self.start, self.series = Pair(*halves(first)), [float(c) for c in rest]
        first, *rest = _interpolate(smooth, _WIDE, 1.0, _MIDST, 13)
        self.smooth_start, self.smooth = Pair(*halves(first)), [float(c) for c in rest]

    def __call__(self, a: Array, b: Array) -> Array:
        """The gap; for a small exponent even a value counts that is nothing beside the other."""
        found = self.scaled(a, b)
        if self.fraction < _SLOW:
            least, most = np.minimum(a, b), np.maximum(a, b)
            where = np.flatnonzero((least > 0) & (least < most * _TOE))
            if where.size:
                found[where] = self.far(least.take(where), most.take(where))
        return found

    def far(self, least: Array, most: Array) -> Array:
        """Where the ratio of the values is below all that d can be told from 1."""
        e = self.exponent[0]
        ratio = np.log(np.ldexp(least, 600)) - np.log(most) - 599 * LN2.high
        shape: Array = np.expm1(e * ratio) + math.expm1(e * LN2.high)
        return shape * -0.5 * raised(0.5 * most, self.exponent)

    def scaled(self, a: Array, b: Array) -> Array:
        """Keep sums and products away from overflow and underflow by a power of two."""
        top = np.maximum(a, b)
        if top.max() <= _REACH and lowest(top) >= 1 / _REACH:
            return self.moderate(a, b)
        shift = np.frexp(top)[1]
        return self.moderate(np.ldexp(a, -shift), np.ldexp(b, -shift)) * self.scale(shift)

    def scale(self, shift: Counts) -> Array:
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
        """The function g of the relative difference."""
        wide = np.flatnonzero(np.abs(d.high) > _WIDE)
        if not wide.size:
            found = self.narrow(_short_square(d))
            return found.high, found.low
        shape, rest = np.empty_like(d.high), np.empty_like(d.high)
        other = np.flatnonzero(np.abs(d.high) <= _WIDE)
        for where, piece in ((wide, self.wide), (other, lambda d: self.narrow(_short_square(d)))):
            found = piece(Pair(d.high.take(where), d.low.take(where)))
            shape[where], rest[where] = found.high, found.low
        return shape, rest

    def narrow(self, q: Pair) -> Pair:
        """The product q (c0 + t); only its own rounding is not kept in the lower half."""
        x = q.high * -_BEND
        x += 1
        np.divide(q.high, x, out=x)
        x -= _CENTRE
        t = horner(self.series, x)
        t *= x
        factor = t + self.start.high
        low = self.start.high - factor
        low += t
        low += self.start.low
        low *= q.high
        q.low *= factor
        low += q.low
        factor *= q.high
        return Pair(factor, low)

    def wide(self, d: Pair) -> Pair:
        """With x**e for x = 1 - |d| from the power function; the rest is smooth next to x = 0."""
        sign = np.where(d.high < 0, -1.0, 1.0)
        d = Pair(d.high * sign, d.low * sign)
        away = (d.high - _MIDST) + d.low
        smooth, error = two_sum(self.smooth_start.high, away * horner(self.smooth, away))
        x, below = two_sum(1 - d.high, -d.low)
        constant, slope = _left_out(self.fraction)
        curved = np.where(x > 0, self.curved(np.maximum(x, _TOE)), -constant)
        tilt = below / np.maximum(x, _TOE)
        lost = self.exponent[0] * ((curved + constant + slope * x) * tilt) - slope * below
        shape, rest = two_difference(smooth, curved / 2)
        return Pair(shape, rest + (error + self.smooth_start.low - lost / 2))

    def curved(self, x: Array) -> Array:
        """The power x**e without the line that is left out."""
        constant, slope = _left_out(self.fraction)
        if not constant and not slope:
            return raised(x, self.exponent)
        turn = log_pair(x) * Pair(*halves(self.fraction - slope))
        less_one = np.expm1(turn.high)
        less_one += turn.low * (less_one + 1)
        return x * less_one if slope else less_one
