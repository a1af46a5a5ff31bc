"""Poisson probabilities and the lower tail for any mean.

Sources: Loader (2000) for the probabilities (saddle point and the error of Stirling's formula);
tails by summing terms away from the mean, and by Temme's uniform expansion (SIAM J. Math. Anal.
10 (1979) 757) where that would take long.
"""

from __future__ import annotations

import math

import numpy as np

from quizgen.arrays.aliases import Array, Numbers, Result
from quizgen.arrays.domain import NONNEGATIVE, Rule
from quizgen.arrays.double_double import Pair, two_sum
from quizgen.arrays.gaussian import mills
from quizgen.arrays.kernel import Kernel
from quizgen.arrays.logarithm import ratio_excess
from quizgen.arrays.polynomial import horner
from quizgen.arrays.tables import STIRLING, TEMME

_ROOT_TWO_PI = 2.5066282746310007
_LARGEST = 2.0**900
_CERTAIN = 800.0
"""An exponent below minus this gives zero."""

_SERIES = (1 / 12, -1 / 360, 1 / 1260, -1 / 1680, 1 / 1188, -691 / 360360, 1 / 156)
_TABLE = np.array(STIRLING)
_NEXT_IS_NO_DOUBLE = 2.0**53
_UNIFORM_FROM = 60.0
_NEGLIGIBLE = 2.0**-60
_UNIFORM_TO = 0.5


def _stirling_error(k: Array) -> Array:
    """Difference ln k! - ln(sqrt(2 pi k) (k/e)**k)."""
    inverse = 1 / np.maximum(k, 1.0)
    total = horner(_SERIES, inverse * inverse)
    table = _TABLE[np.minimum(k, 15.0).astype(np.intp)]
    return np.where(k < 16, table, total * inverse)


def _density(k: Array, lam: Array) -> Array:
    """exp(-lam) lam**k/k! for k >= 1 and lam > 0, k not necessarily the smaller."""
    excess = ratio_excess(k, lam)
    high = np.minimum(excess.high, _CERTAIN)
    low = np.where(excess.high < _CERTAIN, excess.low, 0.0)
    value = np.exp(-high) / (np.sqrt(k) * _ROOT_TWO_PI)
    return value + value * np.expm1(-(low + _stirling_error(k)))


def _pmf(k: Array, lam: Array) -> Array:
    most, least = lam.max(), lam.min()
    ordinary = k.max() < _FACTORIALS.size and least >= _SMALL_MEAN and most <= _LARGE_MEAN
    if ordinary and k.max() * max(math.log(most), -math.log(least), 1.0) < _LARGE_MEAN:
        return _pmf_short(k, lam)
    return _pmf_long(k, lam)


_FACTORIALS = np.array([float(math.factorial(k)) for k in range(171)])
_SMALL_MEAN, _LARGE_MEAN = 1e-4, 690.0


def _pmf_short(k: Array, lam: Array) -> Array:
    """The definition, where neither power nor factorial leaves the range."""
    value: Array = lam**k * np.exp(-lam) / _FACTORIALS.take(k.astype(np.intp))
    return value


def _pmf_long(k: Array, lam: Array) -> Array:
    k, lam = np.broadcast_arrays(k, lam)
    inside = (k > 0) & (lam > 0) & (k < _LARGEST) & (lam < _LARGEST)
    inside &= lam > k / _LARGEST
    value = np.where(k == 0, np.exp(-lam), 0.0)
    value = np.where((k == 1) & (lam <= 1 / _LARGEST), lam, value)
    where = np.flatnonzero(inside)
    if where.size:
        value[where] = _density(k.take(where), lam.take(where))
    vast = np.flatnonzero((k == lam) & (k >= _LARGEST))
    value[vast] = 1 / (np.sqrt(k.take(vast)) * _ROOT_TWO_PI)
    return value


def _sum_up(k: Array, lam: Array) -> Array:
    """P(X >= k)/P(X = k) for k > lam, from the smallest term back to the first."""
    term, count, steps = np.ones_like(k), k.copy(), 0
    while term.max() > _NEGLIGIBLE:
        steps += 1
        count += 1
        term *= lam / count
    total = np.ones_like(k)
    for _ in range(steps):
        total *= lam
        total /= count
        total += 1
        count -= 1
    return total


def _sum_down(k: Array, lam: Array) -> Array:
    """P(X <= k)/P(X = k) for k <= lam, from the smallest term back to the first."""
    term, steps = np.ones_like(k), 0
    while term.max() > _NEGLIGIBLE:
        term *= np.maximum(k - steps, 0.0) / lam
        steps += 1
    total = np.ones_like(k)
    for j in range(steps, 0, -1):
        total *= np.maximum(k - j + 1, 0.0)
        total /= lam
        total += 1
    return total


def _uniform_lower(k: Array, lam: Array) -> Array:
    """P(X <= k), the upper incomplete gamma function of a = k + 1, from its smaller side.

    A next count that is no double is kept as a pair. The exponential of the excess
    stands in front of Mills' ratio, so that its exponent is never squared from a rounded root.
    """
    a, lost = k + 1, 0.0
    if k.max() >= _NEXT_IS_NO_DOUBLE:
        a, lost = two_sum(k, 1.0)
    excess = ratio_excess(Pair(a, lost) if np.ndim(lost) else a, lam)
    root = np.sqrt(2 * excess.high)
    above = lam - a > lost
    eta = np.where(above, 1.0, -1.0) * root / np.sqrt(a)
    rest = np.where(above, 1.0, -1.0) * _uniform_rest(a, eta)
    ratio, skew = mills(root)
    bell = np.exp(-np.minimum(excess.high, _CERTAIN))
    total = ratio + rest
    small = bell * total
    small -= small * (excess.low + skew * ratio / total)
    return np.where(above, small, 1 - small)


def _uniform_rest(a: Array, eta: Array) -> Array:
    """What stands beside Mills' ratio, above the mean."""
    rest = np.zeros_like(a)
    for row in reversed(TEMME):
        rest = rest / a + horner(row, eta)
    return rest / (np.sqrt(a) * _ROOT_TWO_PI)


def _lower(k: Array, lam: Array) -> Array:
    """P(X <= k), from its smaller side."""
    k, lam = np.broadcast_arrays(k, lam)
    value = np.where(k < lam, 0.0, 1.0)
    inside = (lam > 0) & (lam < _LARGEST) & (k < _LARGEST) & (lam > k / _LARGEST)
    a = k + 1
    uniform = inside & (a > _UNIFORM_FROM) & (np.abs(lam - a) < _UNIFORM_TO * a)
    value[(k == lam) & (k >= _LARGEST)] = 0.5
    for way, where in ((_uniform_lower, uniform), (_by_sum, inside & ~uniform)):
        chosen = np.flatnonzero(where)
        if chosen.size:
            value[chosen] = way(k.take(chosen), lam.take(chosen))
    return value


def _by_sum(k: Array, lam: Array) -> Array:
    """Sum whichever side is the smaller one; the other is its complement."""
    above = k >= lam
    first = np.where(above, k + 1, k)
    value = _pmf(first, lam)
    for ratio, where in ((_sum_up, above), (_sum_down, ~above)):
        if where.any():
            value[where] *= ratio(first[where], lam[where])
    return np.where(above, 1 - value, value)


_COUNT = Rule("not-a-count", lambda k, _lam: k != np.floor(k))
_PMF = Kernel(_pmf, (NONNEGATIVE, NONNEGATIVE), (_COUNT,))
_LOWER = Kernel(_lower, (NONNEGATIVE, NONNEGATIVE), (_COUNT,))


def pmf(k: Numbers, lam: Numbers) -> Result:
    """Probability of exactly k photons when lam are expected.

    Parameters
    ----------
    k : array_like
        Count, a whole number >= 0.
    lam : array_like
        Mean, >= 0.

    Returns
    -------
    float or array
        Between 0 and 1.

    Raises
    ------
    DomainError
        ``not-a-count``.
    """
    return _PMF(k, lam)


def lower(k: Numbers, lam: Numbers) -> Result:
    """Probability of k photons or fewer; arguments and errors as ``pmf``."""
    return _LOWER(k, lam)
