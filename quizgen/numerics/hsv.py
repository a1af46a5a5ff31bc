"""HSV to RGB for any hue and for colours outside the gamut.

Source: Smith, SIGGRAPH 1978; H in 60-degree sectors.
"""

from __future__ import annotations

import numpy as np
from flint import fmpq

from quizgen.numerics.domain import REAL, Array, FloatOrArray, Numbers
from quizgen.numerics.double_double import DoubleDouble, as_pairs
from quizgen.numerics.ufunc import StableUfunc


def _hsv_to_rgb_block(H: Array, S: Array, V: Array) -> tuple[Array, ...]:
    """Return R, G and B of a block; NaN, which asks for fractions, where doubles cancel."""
    turned = np.fmod(H, 360.0)
    mirrored = turned < 0
    size = np.abs(turned)
    sector = np.floor(size / 60)
    sector = np.where(size < 60 * sector, sector - 1, sector)
    along = size - 60 * sector
    low = V * (1 - S)
    # (1 - S) + S a/60 has no cancellation for 0 <= S <= 1, unlike 1 - S b/60.
    rising = V * ((1 - S) + S * (along / 60))
    falling = V * ((1 - S) + S * ((60 - along) / 60))
    if S.min() < 0 or S.max() > 1:
        odd = np.flatnonzero(np.broadcast_to((S < 0) | (S > 1), rising.shape))
        S, V = np.broadcast_to(S, rising.shape), np.broadcast_to(V, rising.shape)
        along, some, scale = np.broadcast_to(along, rising.shape)[odd], S[odd], V[odd]
        rising[odd] = scale * _complement_fraction(some, 60 - as_pairs(along)[0])
        falling[odd] = scale * _complement_fraction(some, as_pairs(along)[0])
    V = np.broadcast_to(V, rising.shape)
    low = np.broadcast_to(low, rising.shape)
    pick = sector.astype(np.intp)
    R = np.choose(pick, (V, falling, low, low, rising, V))
    G = np.choose(pick, (rising, V, V, falling, low, low))
    B = np.choose(pick, (low, low, rising, V, V, falling))
    return R, np.where(mirrored, B, G), np.where(mirrored, G, B)


def _complement_fraction(S: Array, degrees: DoubleDouble) -> Array:
    """Return 1 - S degrees/60 to twice the working precision.

    Near 0 it is NaN, which asks for fractions.
    """
    left: Array = (60 - S * degrees).round_to_double() / 60
    return np.where(np.abs(left) < _CLOSE, np.nan, left)


# Where 1 - S degrees/60 nearly vanishes, S degrees/60 is nearly 1, and pairs lose 2**-105 of it:
# a quarter of a rounding of what remains here, four roundings at 2**-56, all digits at 2**-105.
_CLOSE = 2.0**-50


def _hsv_to_rgb_exact(H: fmpq, S: fmpq, V: fmpq) -> tuple[fmpq, ...]:
    """Return R, G and B of one colour as fractions, H in degrees."""
    sixths, depth = H / 60, V * S
    sector = sixths.floor()
    along = sixths - sector
    low, turn = V - depth, int(sector) % 6
    some = V - depth * (along if turn % 2 else 1 - along)
    first, second, third = _CHANNELS[turn]
    values = (V, some, low)
    return values[first], values[second], values[third]


_CHANNELS = ((0, 1, 2), (1, 0, 2), (2, 0, 1), (2, 1, 0), (1, 2, 0), (0, 2, 1))
"""Which of the highest, the changing and the lowest value is red, green and blue, by sector."""

_TO_RGB = StableUfunc(
    _hsv_to_rgb_block,
    (REAL,) * 3,
    exact=_hsv_to_rgb_exact,
    least=2.0**-400,
    reach=2.0**400,
    outputs=3,
)


def hsv_to_rgb(
    H: Numbers, S: Numbers, V: Numbers
) -> tuple[FloatOrArray, FloatOrArray, FloatOrArray]:
    """Return red, green and blue of a hue, saturation and value.

    Parameters
    ----------
    H : array_like
        Hue in degrees, any number of turns, either sign.
    S, V : array_like
        Saturation and value; outside 0 .. 1 the same formulas continue.

    Returns
    -------
    tuple of float or array
        R, G, B on the scale of V.
    """
    result: tuple[FloatOrArray, FloatOrArray, FloatOrArray] = _TO_RGB(H, S, V)
    return result
