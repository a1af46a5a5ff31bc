"""The quantile of the Gaussian, far out as well as at the centre.

Sources: Abramowitz & Stegun, Handbook of Mathematical Functions (1964), chapter 26; Wichura,
Applied Statistics 37 (1988) 477. With Q(k) the probability beyond k, Mills' ratio Q(k) exp(k**2/2)
varies slowly: (k + 3/4) times it is a polynomial in t = (k - 4)/(k + 4) (coefficients in
``tables``). The exponent k**2/2 is carried to twice the working precision: at 37 sigma its rounding
alone would cost 1400 units in the last place.
"""

from __future__ import annotations

import numpy as np

from quizgen.numerics.domain import Array, FloatOrArray, Interval, Numbers
from quizgen.numerics.double_double import evaluate_polynomial, two_product, two_sum
from quizgen.numerics.tables import MILLS, MILLS_SCALE, MILLS_SHIFT
from quizgen.numerics.ufunc import StableUfunc

_PEAK = 0.3989422804014327
"""1/sqrt(2 pi)."""

_MIDDLE = 0.425
"""Shares from the centre that have a fraction of their own."""

_WAY = 0.180625
_NEAR_TAIL, _NEAR_WAY, _FAR_WAY = 5.0, 1.6, 5.0
_QUANTILE_MIDDLE = (
    (3.3871328727963666080, 133.14166789178437745, 1971.5909503065514427, 13731.693765509461125,
     45921.953931549871457, 67265.770927008700853, 33430.575583588128105, 2509.0809287301226727),
    (1.0, 42.313330701600911252, 687.18700749205790830, 5394.1960214247511077,
     21213.794301586595867, 39307.895800092710610, 28729.085735721942674, 5226.4952788528545610),
)  # fmt: skip
_QUANTILE_NEAR = (
    (1.42343711074968357734, 4.63033784615654529590, 5.76949722146069140550,
     3.64784832476320460504, 1.27045825245236838258, 0.241780725177450611770,
     0.0227238449892691845833, 7.74545014278341407640e-4),
    (1.0, 2.05319162663775882187, 1.67638483018380384940, 0.689767334985100004550,
     0.148103976427480074590, 0.0151986665636164571966, 5.47593808499534494600e-4,
     1.05075007164441684324e-9),
)  # fmt: skip
_QUANTILE_FAR = (
    (6.65790464350110377720, 5.46378491116411436990, 1.78482653991729133580,
     0.296560571828504891230, 0.0265321895265761230930, 0.00124266094738807843860,
     2.71155556874348757815e-5, 2.01033439929228813265e-7),
    (1.0, 0.599832206555887937690, 0.136929880922735805310, 0.0148753612908506148525,
     7.86869131145613259100e-4, 1.84631831751005468180e-5, 1.42151175831644588870e-7,
     2.04426310338993978564e-15),
)  # fmt: skip
"""Fractions of Wichura's algorithm AS 241: above and below the line, ascending powers."""


def mills_ratio(k: Array) -> tuple[Array, Array]:
    """Return Mills' ratio Q(k) exp(k**2/2), k >= 0, and the relative error of its denominator."""
    shaped = evaluate_polynomial(MILLS, (k - MILLS_SCALE) / (k + MILLS_SCALE))
    below, lost = two_sum(k, MILLS_SHIFT)
    return shaped / below, lost / below


def _invert_upper_tail(p: Array) -> Array:
    """Return the k with Q(k) = p, by rational functions of the distance from 1/2 or of ln p.

    The fractions are good to one part in 10**16; all coefficients are positive, so that nothing
    cancels.
    """
    less = np.minimum(p, 1 - p)
    share = 0.5 - less
    k: Array = share * _evaluate_rational(_QUANTILE_MIDDLE, _WAY - share * share)
    where = np.flatnonzero(share > _MIDDLE)
    if where.size:
        k[where] = _quantile_of_tail(less.take(where))
    return k if p.max() <= 0.5 else np.where(p > 0.5, -k, k)


def _quantile_of_tail(less: Array) -> Array:
    """Return the k > 0 with Q(k) = p for small p (AS 241), improved by a Newton step far out."""
    log = np.log(less)
    root = np.sqrt(-log)
    k = _evaluate_rational(_QUANTILE_NEAR, root - _NEAR_WAY)
    where = np.flatnonzero(root > _NEAR_TAIL)
    if where.size:
        k[where] = _improve_quantile(
            _evaluate_rational(_QUANTILE_FAR, root.take(where) - _FAR_WAY), log.take(where)
        )
    return k


def _improve_quantile(k: Array, log: Array) -> Array:
    """Return k after one Newton step for ln Q(k) = ln p, whose slope is minus the hazard.

    ``log`` is ln p.
    """
    square, lost = two_product(k, k)
    ratio, skew = mills_ratio(k)
    miss: Array = np.log(ratio) - (skew + 0.5 * lost) - 0.5 * square - log
    return k + miss * ratio / _PEAK


def _evaluate_rational(parts: tuple[tuple[float, ...], tuple[float, ...]], x: Array) -> Array:
    """Return the quotient of two polynomials in x, each with ascending coefficients."""
    above, below = parts
    return evaluate_polynomial(above, x) / evaluate_polynomial(below, x)


_INVERSE = StableUfunc(
    _invert_upper_tail, (Interval(low=0.0, high=1.0, reason="not-a-probability"),)
)


def inverse_upper_tail(p: Numbers) -> FloatOrArray:
    """Return the k that a standard normal value exceeds with probability p, in standard deviations.

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
