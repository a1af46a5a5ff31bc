"""Decoding of sRGB (IEC 61966-2-1).

Its exponent is read as a decimal (2.4 is twelve fifths) and carried to twice the working precision,
because the error of a rounded exponent is multiplied by the logarithm of the intensity.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from quizgen.numerics.domain import Array, FloatOrArray, Interval, Numbers
from quizgen.numerics.double_double import (
    DoubleDouble,
    power_with_remainder,
    split_exponent,
    two_sum,
)
from quizgen.numerics.ufunc import StableUfunc

_INTENSITY = Interval(low=0.0, reason="negative-intensity", closed=True)


# The published decimals, carried exactly where they meet a subtraction.
_SLOPE = 12.92
_OFFSET = DoubleDouble(0.055, float(Fraction("0.055") - Fraction(0.055)))
_SHRINK = DoubleDouble(0.8794154614021299, 2.4981572779044743e-17)
"""1.055**-2.4."""
_DECODE = split_exponent(Fraction(12, 5))
_KNEE = 0.04045
_OVERFLOWS = 2.0**600


def _decode_srgb(x: Array) -> Array:
    """Return linear intensities of encoded ones >= 0: the formula of `srgb_decode` on a block."""
    base, lost = two_sum(np.minimum(x, _OVERFLOWS), _OFFSET.high)
    lost += _OFFSET.low
    lost /= base
    bright = power_with_remainder(base, _DECODE) * _SHRINK.high
    bright += bright * (2.4 * lost + _SHRINK.low / _SHRINK.high)
    dim = np.flatnonzero(x <= _KNEE)
    bright[dim] = x.take(dim) / _SLOPE
    return bright


_SRGB_DECODE = StableUfunc(_decode_srgb, (_INTENSITY,))


def srgb_decode(encoded: Numbers) -> FloatOrArray:
    """Return the linear intensities (1 = white) of sRGB-encoded ones.

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
