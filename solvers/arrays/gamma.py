"""Gamma and sRGB encoding, and what averaging encoded values gets wrong.

Sources: I_enc = I_lin**(1/gamma); sRGB: IEC 61966-2-1. Exponents are read as decimals (2.2 is
eleven fifths) and carried to twice the working precision, because the error of a rounded
exponent is multiplied by the logarithm of the intensity.
"""

from __future__ import annotations

import decimal
import math
import operator
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from .domain import Array, DomainError, Kernel, Numbers, Result, Span, read_decimal
from .double_double import Pair, pairs, two_sum

_INTENSITY = Span(low=0.0, reason="negative-intensity", closed=True)


Exponent = tuple[float, float]
"""An exponent and what rounding it lost."""

_UNIT = 2.0**-53
_LEAST = 5e-324


def _power(x: Array, exponent: Exponent) -> Array:
    """Raise to a power with the exponent carried to twice the working precision."""
    high, low = exponent
    y: Array = x**high
    least = x.min()
    if low == 0 or (least > 0 and abs(low) * max(-math.log(least), math.log(x.max())) < _UNIT):
        return y
    y *= 1 + low * np.log(np.maximum(x, _LEAST))
    return y


def _halves(exponent: Fraction) -> Exponent:
    high = float(exponent)
    return high, float(exponent - Fraction(high))


def _positive(gamma: float) -> Fraction:
    exponent = read_decimal(gamma)
    if exponent <= 0:
        raise DomainError("not-positive")
    return exponent


def encode(linear: Numbers, gamma: float = 2.2) -> Result:
    """Encode linear intensities, I**(1/gamma).

    Parameters
    ----------
    linear : array_like
        Linear intensities, >= 0.
    gamma : float
        Exponent read as a decimal, > 0.

    Returns
    -------
    float or array
        Encoded intensities.

    Raises
    ------
    DomainError
        ``negative-intensity``, ``not-finite`` (arrays: masked); ``not-positive`` for gamma.
    """
    return _power_kernel(1 / _positive(gamma))(linear)


def decode(encoded: Numbers, gamma: float = 2.2) -> Result:
    """Decode to linear intensities, I**gamma.

    Parameters
    ----------
    encoded : array_like
        Encoded intensities, >= 0.
    gamma : float
        Exponent read as a decimal, > 0.

    Returns
    -------
    float or array
        Linear intensities.

    Raises
    ------
    DomainError
        ``negative-intensity``, ``not-finite`` (arrays: masked); ``not-positive`` for gamma.
    """
    return _power_kernel(_positive(gamma))(encoded)


@lru_cache(maxsize=32)
def _power_kernel(exponent: Fraction) -> Kernel:
    halves = _halves(exponent)
    return Kernel(lambda x: _power(x, halves), (_INTENSITY,))


# sRGB: the published decimals, carried exactly where they meet a subtraction.

_SLOPE = Pair(12.92, float(Fraction("12.92") - Fraction(12.92)))
_STRETCH = Pair(1.055, float(Fraction("1.055") - Fraction(1.055)))
_OFFSET = Pair(0.055, float(Fraction("0.055") - Fraction(0.055)))
_SHRINK = Pair(0.8794154614021299, 2.4981572779044743e-17)
"""1.055**-2.4."""
_ENCODE = _halves(Fraction(5, 12))
_DECODE = _halves(Fraction(12, 5))
_KNEE_LINEAR = 0.0031308
_KNEE_ENCODED = 0.04045
_TOE = 2.0**-900
_OVERFLOWS = 2.0**600


def _srgb_encode(x: Array) -> Array:
    power = _power(np.maximum(x, _KNEE_LINEAR), _ENCODE)
    bright = power * _STRETCH.high - _OFFSET.high
    bright += power * _STRETCH.low - _OFFSET.low
    return _with_toe(bright, x, x <= _KNEE_LINEAR, lambda toe: toe * _SLOPE, 12.92)


def _srgb_decode(x: Array) -> Array:
    base, lost = two_sum(np.minimum(x, _OVERFLOWS), _OFFSET.high)
    lost += _OFFSET.low
    lost /= base
    bright = _power(base, _DECODE) * _SHRINK.high
    bright += bright * (2.4 * lost + _SHRINK.low / _SHRINK.high)
    return _with_toe(bright, x, x <= _KNEE_ENCODED, lambda toe: toe / _SLOPE, 1 / 12.92)


def _with_toe(bright: Array, x: Array, dark: Any, line: Any, slope: float) -> Array:
    """Fill in the straight piece; products of pairs need room below for their errors."""
    where = np.flatnonzero(dark)
    if where.size:
        toe = x.take(where)
        small = toe < _TOE
        value = line(pairs(np.where(small, 1.0, toe))[0]).rounded()
        bright[where] = np.where(small, toe * slope, value)
    return bright


_SRGB_ENCODE = Kernel(_srgb_encode, (_INTENSITY,))
_SRGB_DECODE = Kernel(_srgb_decode, (_INTENSITY,))


def srgb_encode(linear: Numbers) -> Result:
    """Encode linear intensities as sRGB.

    Parameters
    ----------
    linear : array_like
        Linear intensities, >= 0 (above 1 the power continues).

    Returns
    -------
    float or array
        12.92 x up to 0.0031308, then 1.055 x**(1/2.4) - 0.055.

    Raises
    ------
    DomainError
        ``negative-intensity``, ``not-finite`` (arrays: masked).
    """
    return _SRGB_ENCODE(linear)


def srgb_decode(encoded: Numbers) -> Result:
    """Decode sRGB to linear intensities.

    Parameters
    ----------
    encoded : array_like
        Encoded intensities, >= 0.

    Returns
    -------
    float or array
        x/12.92 up to 0.04045, then ((x + 0.055)/1.055)**2.4.

    Raises
    ------
    DomainError
        ``negative-intensity``, ``not-finite`` (arrays: masked).
    """
    return _SRGB_DECODE(encoded)


# The gap enc(mean) - mean(enc). With m the mean and d = |b - a|/(a + b) it is m**e g(d**2),
# g(q) = 1 - ((1 + d)**e + (1 - d)**e)/2: a polynomial in q = d**2 while d <= 3/4.

_SERIES = 0.5
_SHIFTED = 0.75
_CENTRE = 0.40625
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
    total = np.full_like(x, coefficients[-1])
    for c in reversed(coefficients[:-1]):
        total *= x
        total += c
    return total


class _Gap:
    """The gap for one exponent, with its coefficients."""

    def __init__(self, e: Fraction) -> None:
        self.fraction = e
        self.exponent = _halves(e)
        over_q, of_q, smooth = _direct(e)
        first, *rest = _interpolate(over_q, 0.0, _SERIES**2, 0.0, 16)
        self.start, self.series = Pair(*_halves(first)), [float(c) for c in rest]
        first, *rest = _interpolate(of_q, _SERIES**2, _SHIFTED**2, _CENTRE, 20)
        self.around_start, self.around = Pair(*_halves(first)), [float(c) for c in rest]
        first, *rest = _interpolate(smooth, _SHIFTED, 1.0, 0.875, 13)
        self.smooth_start, self.smooth = Pair(*_halves(first)), [float(c) for c in rest]

    def __call__(self, a: Array, b: Array) -> Array:
        """Keep sums and products away from overflow and underflow by a power of two."""
        top = np.maximum(a, b)
        if top.max() <= 2.0**400 and top.min() >= 2.0**-400:
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
        total = pairs(a)[0] + b
        if total.high.min() == 0:
            total = Pair(np.maximum(total.high, _TOE), total.low)
        d = (pairs(b)[0] - a) / total
        size = np.abs(d.high)
        shape, rest = np.empty_like(size), np.empty_like(size)
        small = size <= _SERIES
        wide = size > _SHIFTED
        for part, flags in (
            (self.small, small),
            (self.middle, ~(small | wide)),
            (self.wide, wide),
        ):
            where = np.flatnonzero(flags)
            if where.size:
                found = part(Pair(d.high.take(where), d.low.take(where)))
                shape[where], rest[where] = found.high, found.low
        power = _power(total.high / 2, self.exponent)
        rest += shape * (self.exponent[0] * (total.low / total.high))
        shape *= power
        rest *= power
        shape += rest
        return shape

    def small(self, d: Pair) -> Pair:
        q = d * d
        return q * (self.start + q.high * _horner(self.series, q.high))

    def middle(self, d: Pair) -> Pair:
        q = d * d
        x = (q.high - _CENTRE) + q.low
        high, low = two_sum(self.around_start.high, x * _horner(self.around, x))
        return Pair(high, low + self.around_start.low)

    def wide(self, d: Pair) -> Pair:
        sign = np.where(d.high < 0, -1.0, 1.0)
        d = Pair(d.high * sign, d.low * sign)
        x = (d.high - 0.875) + d.low
        smooth, error = two_sum(self.smooth_start.high, x * _horner(self.smooth, x))
        left, below = two_sum(1 - d.high, -d.low)
        power = _power(left, self.exponent)
        lost = power * (self.exponent[0] * (below / np.maximum(left, _TOE)))
        return Pair(smooth - power / 2, error + self.smooth_start.low - lost / 2)


@lru_cache(maxsize=16)
def _gap_kernel(e: Fraction) -> Kernel:
    return Kernel(_Gap(e), (_INTENSITY, _INTENSITY))


def gap(a: Numbers, b: Numbers, gamma: float = 2.2) -> Result:
    """How much brighter the encoded mean is than the mean of the encoded values.

    Parameters
    ----------
    a, b : array_like
        Linear intensities, >= 0.
    gamma : float
        Exponent read as a decimal, >= 1.

    Returns
    -------
    float or array
        enc((a + b)/2) - (enc(a) + enc(b))/2, >= 0, without subtracting nearly equal values.

    Raises
    ------
    DomainError
        ``negative-intensity``, ``not-finite`` (arrays: masked); ``not-positive`` for gamma < 1.
    """
    exponent = 1 / _positive(gamma)
    if exponent > 1:
        raise DomainError("not-positive")
    return _gap_kernel(exponent)(a, b)
