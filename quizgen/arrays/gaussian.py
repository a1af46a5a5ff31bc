"""The Gaussian: tails and quantile, far out as well as at the centre.

Sources: Abramowitz & Stegun, Handbook of Mathematical Functions (1964), chapter 26. Q(k) =
exp(-k**2/2) R(k) with R Mills' ratio over sqrt(2 pi), which varies slowly and is a polynomial in
t = (k - 4)/(k + 4) after multiplication by (k + 3/4) (coefficients in ``tables``). The exponent
k**2/2 is carried to twice the working precision: at 37 sigma its rounding alone would cost 1400
units in the last place.
"""

from __future__ import annotations

import numpy as np

from quizgen.arrays.aliases import Array, Numbers, Result
from quizgen.arrays.domain import REAL, Span
from quizgen.arrays.double_double import two_product, two_sum
from quizgen.arrays.kernel import Kernel
from quizgen.arrays.polynomial import horner
from quizgen.arrays.tables import CENTRAL, MILLS, MILLS_SCALE, MILLS_SHIFT

_PEAK = 0.3989422804014327
"""1/sqrt(2 pi)."""

_FAR = 40.0
"""Beyond 40 sigma the tail is below the smallest positive double."""

_CENTRAL = 0.7
"""Below this Q is close to 1/2 and better computed as 1/2 minus the probability from 0 to k."""

_STEPS = 2
"""Halley steps from an error below 5e-4; each cubes it."""

_MIDDLE = 0.38


def mills(k: Array) -> tuple[Array, Array]:
    """Q(k) exp(k**2/2) for k >= 0, and the relative error of its denominator."""
    shaped = horner(MILLS, (k - MILLS_SCALE) / (k + MILLS_SCALE))
    below, lost = two_sum(k, MILLS_SHIFT)
    return shaped / below, lost / below


def far_tail(k: Array) -> Array:
    """Q(k) for k >= 0, best where k is not small."""
    k = np.minimum(k, _FAR)
    square, lost = two_product(k, k)
    ratio, skew = mills(k)
    square *= -0.5
    value: Array = np.exp(square)
    value *= ratio
    lost *= 0.5
    lost += skew
    value -= value * lost
    return value


def near_tail(k: Array) -> Array:
    """Q(k) for 0 <= k below 0.7."""
    result: Array = 0.5 - k * horner(CENTRAL, k * k)
    return result


def _tail(k: Array) -> Array:
    """Q(k) for k >= 0."""
    tail = far_tail(k)
    if k.min() < _CENTRAL:
        where = np.flatnonzero(k < _CENTRAL)
        tail[where] = near_tail(k.take(where))
    return tail


def _upper_tail(k: Array) -> Array:
    tail = _tail(np.abs(k))
    return tail if k.min() >= 0 else np.where(k < 0, 1 - tail, tail)


def _two_sided(k: Array) -> Array:
    tail = 2 * _tail(np.abs(k))
    return tail if k.min() >= 0 else np.where(k < 0, 1.0, tail)


def _inverse_tail(p: Array) -> Array:
    """Solve Q(k) = p, for the probability from the centre or the logarithm of the tail."""
    less = np.minimum(p, 1 - p)
    log = np.log(less)
    t = np.sqrt(-2 * log)  # the start is 26.2.23 of the handbook
    k = t - (2.515517 + t * (0.802853 + t * 0.010328)) / (
        1 + t * (1.432788 + t * (0.189269 + t * 0.001308))
    )
    np.maximum(k, 0.0, out=k)
    central = less > 0.5 - _MIDDLE
    for solve, flags in ((_from_share, central), (_from_log, ~central)):
        where = np.flatnonzero(flags)
        if where.size:
            k[where] = solve(k.take(where), less.take(where), log.take(where))
    return k if p.max() <= 0.5 else np.where(p > 0.5, -k, k)


def _from_share(k: Array, less: Array, _log: Array) -> Array:
    """Solve P(0 < n < k) = share, with density d the second derivative is -k d."""
    share = 0.5 - less
    lost = (0.5 - share) - less
    for _ in range(_STEPS):
        square = k * k
        miss = (k * horner(CENTRAL, square) - share - lost) * np.exp(0.5 * square) / _PEAK
        k = np.maximum(k - miss / (1 + 0.5 * miss * k), 0.0)
    return k


def _from_log(k: Array, _less: Array, log: Array) -> Array:
    """Solve ln Q(k) = log, whose slope is minus the hazard h and the next one h (k - h)."""
    for _ in range(_STEPS):
        square, lost = two_product(k, k)
        ratio, skew = mills(k)
        hazard = _PEAK / ratio
        miss = (np.log(ratio) - (skew + 0.5 * lost) - 0.5 * square - log) / hazard
        k = k + miss / (1 + 0.5 * miss * (hazard - k))
    return k


_UPPER = Kernel(_upper_tail, (REAL,))
_BOTH = Kernel(_two_sided, (REAL,))
_INVERSE = Kernel(_inverse_tail, (Span(low=0.0, high=1.0, reason="not-a-probability"),))


def upper_tail(k: Numbers) -> Result:
    """Probability Q(k) that a standard normal value exceeds k.

    Parameters
    ----------
    k : array_like
        Standard deviations, either sign.

    Returns
    -------
    float or array
        Between 0 and 1; rounds to 0 above 38.485.
    """
    return _UPPER(k)


def two_sided_tail(k: Numbers) -> Result:
    """Probability that a standard normal value is farther than k from 0.

    Parameters
    ----------
    k : array_like
        Standard deviations; the answer is 1 when negative.

    Returns
    -------
    float or array
        Between 0 and 1.
    """
    return _BOTH(k)


def inverse_tail(p: Numbers) -> Result:
    """The k with Q(k) = p.

    Parameters
    ----------
    p : array_like
        Probability, 0 < p < 1.

    Returns
    -------
    float or array
        Standard deviations.

    Raises
    ------
    DomainError
        ``not-a-probability``.
    """
    return _INVERSE(p)
