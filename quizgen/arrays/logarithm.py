"""Natural logarithm to twice the working precision.

Source: x = 2**e m with m next to 1, ln m = 2 atanh((m - 1)/(m + 1)); the first terms of the
series are pairs, the rest is small enough for doubles. Relative error about 2**-70.
"""

from __future__ import annotations

import numpy as np

from quizgen.arrays.aliases import Array
from quizgen.arrays.double_double import Pair, pair, pairs
from quizgen.arrays.polynomial import horner

LN2 = Pair(0.6931471805599453, 2.3190468138462996e-17)
_THIRD = Pair(1 / 3, 1.850371707708594e-17)
_FIFTH = Pair(0.2, -1.1102230246251566e-17)
_TAIL = tuple(1.0 / n for n in range(7, 35, 2))
_ROOT_HALF = 0.7071067811865476


def atanh_series(s2: Pair) -> Pair:
    """Series atanh(s)/s - 1 = s**2/3 + s**4/5 + ... for s**2 below 0.03."""
    return s2 * (_THIRD + s2 * (_FIFTH + s2 * horner(_TAIL, s2.high)))


def log_pair(x: Array) -> Pair:
    """Natural logarithm of positive doubles as a pair."""
    m, e = np.frexp(x)
    low = m < _ROOT_HALF
    m, e = np.where(low, 2 * m, m), e - low
    m_pair = pairs(m)[0]
    s = (m_pair - 1) / (m_pair + 1)
    return LN2 * e.astype(np.float64) + 2 * (s + s * atanh_series(s * s))


def ratio_excess(x: Array | Pair, y: Array) -> Pair:
    """Excess x ln(x/y) - (x - y) >= 0 for positive x and y, close ones too.

    A pair is taken as such only where it is close to y.

    Source: Loader (2000), "Fast and accurate computation of binomial probabilities": with
    v = (x - y)/(x + y) it is v (x - y) + 2 x v (v**2/3 + v**4/5 + ...).
    """
    x_pair, y_pair = pair(x), pair(y)
    difference = x_pair - y_pair
    v = difference / (x_pair + y_pair)
    near = np.abs(v.high) < 0.17
    safe = Pair(np.where(near, v.high, 0.0), np.where(near, v.low, 0.0))
    close = safe * difference + 2 * (x_pair * (safe * atanh_series(safe * safe)))
    if near.all():
        return close
    wide = x_pair * (log_pair(x_pair.high) - log_pair(y)) - difference
    return Pair(np.where(near, close.high, wide.high), np.where(near, close.low, wide.low))
