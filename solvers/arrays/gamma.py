"""Gamma and sRGB encoding, and what averaging encoded values gets wrong.

Sources: I_enc = I_lin**(1/gamma); sRGB: IEC 61966-2-1. Exponents are read as decimals (2.2 is
eleven fifths) and carried to twice the working precision, because the error of a rounded
exponent is multiplied by the logarithm of the intensity.
"""

from __future__ import annotations

import decimal
import math
from collections.abc import Sequence
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
_ENCODE = _halves(Fraction(5, 12))
_DECODE = _halves(Fraction(12, 5))
_KNEE_LINEAR = 0.0031308
_KNEE_ENCODED = 0.04045
_TOE = 2.0**-900
_OVERFLOWS = 2.0**600


def _srgb_encode(x: Array) -> Array:
    bright = (_STRETCH * _power(np.maximum(x, _KNEE_LINEAR), _ENCODE) - _OFFSET).rounded()
    return _with_toe(bright, x, x <= _KNEE_LINEAR, lambda toe: toe * _SLOPE, 12.92)


def _srgb_decode(x: Array) -> Array:
    base = (pairs(np.clip(x, _KNEE_ENCODED, _OVERFLOWS))[0] + _OFFSET) / _STRETCH
    bright = _power(base.high, _DECODE) * (1 + 2.4 * (base.low / base.high))
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
# g(q) = 1 - ((1 + d)**e + (1 - d)**e)/2 = sum of c_j q**j with all c_j of one sign.

_SERIES = 0.5
_SHIFTED = 0.75
_CENTRE = 0.4
_DIGITS = decimal.Context(prec=50)


def _series(e: Fraction) -> list[Fraction]:
    """Coefficients -C(e, 2j) for j = 1, 2, ... far enough for q <= 0.5625."""
    coefficients, binomial = [], Fraction(1)
    for j in range(1, 161):
        binomial *= (e - 2 * j + 2) * (e - 2 * j + 1) / ((2 * j - 1) * (2 * j))
        binomial = binomial.limit_denominator(10**60)
        coefficients.append(-binomial)
    return coefficients


def _around_centre(e: Fraction) -> list[float]:
    """Taylor coefficients of g around q = 0.4."""
    values = [_DIGITS.divide(*map(decimal.Decimal, c.as_integer_ratio())) for c in _series(e)]
    values.insert(0, decimal.Decimal(0))
    centre = decimal.Decimal(_CENTRE)
    result = []
    for n in range(30):
        total = decimal.Decimal(0)
        for c in reversed(values):
            total = _DIGITS.fma(total, centre, c)
        result.append(float(total))
        values = [
            _DIGITS.divide(_DIGITS.multiply(c, decimal.Decimal(j)), decimal.Decimal(n + 1))
            for j, c in enumerate(values)
        ][1:]
    return result


def _one_sided(e: Fraction) -> list[Fraction]:
    """Taylor coefficients of 1 - (1 + d)**e/2 around d = 7/8."""
    exponent = _DIGITS.divide(*map(decimal.Decimal, e.as_integer_ratio()))
    base = Fraction(_DIGITS.power(decimal.Decimal("1.875"), exponent))
    coefficients, binomial = [1 - base / 2], Fraction(1)
    for j in range(1, 16):
        binomial *= (e - j + 1) / j
        coefficients.append(-binomial * base / Fraction("1.875") ** j / 2)
    return coefficients


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
        first, *rest = _series(e)[:29]
        self.start, self.series = Pair(*_halves(first)), [float(c) for c in rest]
        self.around = _around_centre(e)
        first, *rest = _one_sided(e)
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
        shape = np.empty_like(size)
        small = size <= _SERIES
        wide = size > _SHIFTED
        for part, flags in (
            (self.small, small),
            (self.middle, ~(small | wide)),
            (self.wide, wide),
        ):
            where = np.flatnonzero(flags)
            if where.size:
                shape[where] = part(Pair(d.high.take(where), d.low.take(where)))
        shape *= _power(total.high / 2, self.exponent)
        shape += shape * (self.exponent[0] * (total.low / total.high))
        return shape

    def small(self, d: Pair) -> Array:
        q = d * d
        return (q * (self.start + q.high * _horner(self.series, q.high))).rounded()

    def middle(self, d: Pair) -> Array:
        q = d * d
        return _horner(self.around, (q.high - _CENTRE) + q.low)

    def wide(self, d: Pair) -> Array:
        sign = np.where(d.high < 0, -1.0, 1.0)
        d = Pair(d.high * sign, d.low * sign)
        x = (d.high - 0.875) + d.low
        smooth, error = two_sum(self.smooth_start.high, x * _horner(self.smooth, x))
        left, below = two_sum(1 - d.high, -d.low)
        power = _power(left, self.exponent)
        lost = power * (self.exponent[0] * (below / np.maximum(left, _TOE)))
        result: Array = (smooth - power / 2) + (error + self.smooth_start.low - lost / 2)
        return result


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

