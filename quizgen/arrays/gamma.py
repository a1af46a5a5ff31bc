"""Gamma and sRGB encoding, and what averaging encoded values gets wrong.

Sources: I_enc = I_lin**(1/gamma); sRGB: IEC 61966-2-1. Exponents are read as decimals (2.2 is
eleven fifths) and carried to twice the working precision, because the error of a rounded
exponent is multiplied by the logarithm of the intensity.
"""

from __future__ import annotations

import math
from fractions import Fraction
from functools import lru_cache

import numpy as np

from quizgen.arrays.aliases import Array, Numbers, Result
from quizgen.arrays.domain import DomainError, Span
from quizgen.arrays.double_double import Pair, two_sum
from quizgen.arrays.gamma_gap import Gap
from quizgen.arrays.kernel import Kernel
from quizgen.arrays.power import halves, raised

_INTENSITY = Span(low=0.0, reason="negative-intensity", closed=True)


def _exponent(gamma: float) -> Fraction:
    """1/gamma, read as the decimal that gamma prints as: 2.2 is eleven fifths."""
    value = float(gamma)
    if not math.isfinite(value):
        raise DomainError("not-finite")
    if value < 1:
        raise DomainError("not-positive")
    return 1 / Fraction(repr(value))


# sRGB: the published decimals, carried exactly where they meet a subtraction.

_SLOPE = 12.92
_OFFSET = Pair(0.055, float(Fraction("0.055") - Fraction(0.055)))
_SHRINK = Pair(0.8794154614021299, 2.4981572779044743e-17)
"""1.055**-2.4."""
_DECODE = halves(Fraction(12, 5))
_KNEE = 0.04045
_OVERFLOWS = 2.0**600


def _srgb_decode(x: Array) -> Array:
    base, lost = two_sum(np.minimum(x, _OVERFLOWS), _OFFSET.high)
    lost += _OFFSET.low
    lost /= base
    bright = raised(base, _DECODE) * _SHRINK.high
    bright += bright * (2.4 * lost + _SHRINK.low / _SHRINK.high)
    dim = np.flatnonzero(x <= _KNEE)
    bright[dim] = x.take(dim) / _SLOPE
    return bright


_SRGB_DECODE = Kernel(_srgb_decode, (_INTENSITY,))


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
    return Kernel(Gap(e), (_INTENSITY,) * 2)


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
    return _gap_kernel(_exponent(gamma))(a, b)
