"""Gamma and sRGB encoding, and what averaging encoded values gets wrong.

Sources: I_enc = I_lin**(1/gamma); sRGB: IEC 61966-2-1. Exponents are read as decimals (2.2 is
eleven fifths) and carried to twice the working precision, because the error of a rounded
exponent is multiplied by the logarithm of the intensity.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache

import numpy as np

from quizgen.arrays.aliases import Array, Flags, Numbers, Result
from quizgen.arrays.domain import DomainError, Span
from quizgen.arrays.double_double import Pair, pairs, two_sum
from quizgen.arrays.gamma_gap import REACH as GAP_REACH
from quizgen.arrays.gamma_gap import Gap
from quizgen.arrays.kernel import Kernel, Short, filled
from quizgen.arrays.power import halves, raised
from quizgen.arrays.rational import read_decimal

_INTENSITY = Span(low=0.0, reason="negative-intensity", closed=True)


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
        ``not-positive`` for gamma.
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
        ``not-positive`` for gamma.
    """
    return _power_kernel(_positive(gamma))(encoded)


@lru_cache(maxsize=32)
def _power_kernel(exponent: Fraction) -> Kernel:
    known = halves(exponent)
    return Kernel(lambda x: raised(x, known), (_INTENSITY,))


# sRGB: the published decimals, carried exactly where they meet a subtraction.

_SLOPE = Pair(12.92, float(Fraction("12.92") - Fraction(12.92)))
_STRETCH = Pair(1.055, float(Fraction("1.055") - Fraction(1.055)))
_OFFSET = Pair(0.055, float(Fraction("0.055") - Fraction(0.055)))
_SHRINK = Pair(0.8794154614021299, 2.4981572779044743e-17)
"""1.055**-2.4."""
_ENCODE = halves(Fraction(5, 12))
_DECODE = halves(Fraction(12, 5))
_KNEE_LINEAR = 0.0031308
_KNEE_ENCODED = 0.04045
_TOE = 2.0**-900
_OVERFLOWS = 2.0**600


def _srgb_encode(x: Array) -> Array:
    power = raised(np.maximum(x, _KNEE_LINEAR), _ENCODE)
    bright = power * _STRETCH.high - _OFFSET.high
    bright += power * _STRETCH.low - _OFFSET.low
    return _with_toe(bright, x, x <= _KNEE_LINEAR, lambda toe: toe * _SLOPE, 12.92)


def _srgb_decode(x: Array) -> Array:
    base, lost = two_sum(np.minimum(x, _OVERFLOWS), _OFFSET.high)
    lost += _OFFSET.low
    lost /= base
    bright = raised(base, _DECODE) * _SHRINK.high
    bright += bright * (2.4 * lost + _SHRINK.low / _SHRINK.high)
    return _with_toe(bright, x, x <= _KNEE_ENCODED, lambda toe: toe / _SLOPE, 1 / 12.92)


def _with_toe(
    bright: Array, x: Array, dark: Flags, line: Callable[[Pair], Pair], slope: float
) -> Array:
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
    """
    return _SRGB_DECODE(encoded)


@lru_cache(maxsize=16)
def _gap_kernel(e: Fraction) -> Kernel:
    if e == 1:
        return Kernel(lambda a, b: np.zeros(max(a.size, b.size)), (_INTENSITY,) * 2)
    gap = Gap(e)
    return Kernel(gap, (_INTENSITY,) * 2, short=Short(filled(gap.moderate), GAP_REACH))


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
        ``not-positive`` for gamma < 1.
    """
    exponent = 1 / _positive(gamma)
    if exponent > 1:
        raise DomainError("not-positive")
    return _gap_kernel(exponent)(a, b)
