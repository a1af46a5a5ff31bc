"""How the Gaussian functions are computed, on blocks of ordinary arrays.

Sources: Q(k) = exp(-k**2/2) R(k) with R Mills' ratio over sqrt(2 pi), which varies slowly and is
a polynomial in t = (k - 4)/(k + 4) after multiplication by (k + 3/4) (coefficients in
``tables``). The exponent k**2/2 is carried to twice the working precision: at 37 sigma its
rounding alone would cost 1400 units in the last place.
"""

from __future__ import annotations

import numpy as np

from quizgen.arrays.aliases import Array, Counts, Flags, Formula, Limits
from quizgen.arrays.double_double import split, two_difference, two_product, two_sum
from quizgen.arrays.polynomial import horner
from quizgen.arrays.tables import CENTRAL, MILLS, MILLS_SCALE, MILLS_SHIFT

_PEAK = 0.3989422804014327
_PEAK_LOST = -6.247337834861335e-17
"""1/sqrt(2 pi) and, relative to it, what its rounding lost."""

_FAR = 40.0
"""Beyond 40 sigma the tail is below the smallest positive double."""

_NEAR = 1.2
"""Below this the probability from the centre is a Taylor polynomial, above it 1/2 - Q."""

_CENTRAL = 0.7
"""Below this Q is close to 1/2 and better computed as 1/2 minus that polynomial."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_TOP = 2.0**300


def mills(k: Array) -> tuple[Array, Array]:
    """Q(k) exp(k**2/2) for k >= 0, and the relative error of its denominator."""
    shaped = horner(MILLS, (k - MILLS_SCALE) / (k + MILLS_SCALE))
    below, lost = two_sum(k, MILLS_SHIFT)
    return shaped / below, lost / below


def _tail(k: Array) -> Array:
    """Q(k) for k >= 0."""
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


def _refined_tail(k: Array) -> Array:
    """Q(k) for k >= 0, from the centre where that rounds less."""
    tail = _tail(k)
    if k.min() < _CENTRAL:
        where = np.flatnonzero(k < _CENTRAL)
        near = k.take(where)
        tail[where] = 0.5 - near * horner(CENTRAL, near * near)
    return tail


def upper_tail(k: Array) -> Array:
    """Q(k) for either sign."""
    tail = _refined_tail(np.abs(k))
    return tail if k.min() >= 0 else np.where(k < 0, 1 - tail, tail)


def two_sided(k: Array) -> Array:
    """Twice Q(k), and 1 for negative k."""
    tail = 2 * _refined_tail(np.abs(k))
    return tail if k.min() >= 0 else np.where(k < 0, 1.0, tail)


def expected(M: Array, k: Array) -> Array:
    """M times the two-sided tail; the exponential is split where it would be subnormal."""
    k = np.abs(k)
    value: Array = M * (2 * _refined_tail(k))
    if k.max() < 37:
        return value
    far = np.minimum(k, 80.0)
    square, lost = two_product(far, far)
    ratio, skew = mills(far)
    half = np.exp(square * -0.25)
    whole = (M * half) * half * (2 * ratio)
    return np.where(k < 37, value, whole - whole * (lost / 2 + skew))


def _from_centre(k: Array) -> Array:
    """P(0 < n < k) for k >= 0."""
    near = k < _NEAR
    value = 0.5 - _tail(k)
    return np.where(near, k * horner(CENTRAL, np.where(near, k * k, 0.0)), value)


def log_tail(k: Array) -> Array:
    """Logarithm of Q(k)."""
    size = np.abs(k)
    ratio, skew = mills(size)
    moderate = np.minimum(size, _TOP)
    square, lost = two_product(moderate, moderate)
    far = np.where(size > _TOP, -0.5 * size * size, np.log(ratio) - (skew + lost / 2) - square / 2)
    return np.where(k < 0, np.log1p(-_refined_tail(size)), far) if k.min() < 0 else far


def pdf(x: Array, mu: Array, sigma: Array) -> Array:
    """Density, by the shortest way that keeps its digits."""
    largest = max(x.max(), -x.min(), mu.max(), -mu.min(), sigma.max())
    if largest < _TOP and sigma.min() > 1 / _TOP:
        short = _pdf_short(x, mu, sigma)
        return short if short is not None else _bell(*two_sum(x, -mu), sigma, None)
    scale = np.where(np.maximum(np.abs(x), np.abs(mu)) > 2.0**1000, 0.25, 1.0)
    size, shift = np.frexp(sigma)
    distance, lost = two_sum(x * scale, -mu * scale)
    by = 2 * (scale < 1) - shift
    return _bell(np.ldexp(distance, by), np.ldexp(lost, by), size, shift)


def near_centre(x: Limits, mu: Limits, sigma: Limits) -> bool:
    """Whether limits keep the density within _CLOSE standard deviations of one Gaussian."""
    return (
        mu[0] == mu[1]
        and 1 / _TOP < sigma[0] == sigma[1]
        and max(x[1] - mu[0], mu[0] - x[0]) <= _CLOSE * sigma[0]
    )


_CLOSE = 1.95
_FINE = 1.5 * 2.0**28
"""Adding and taking away this rounds to a multiple of 2**-24."""


def pdf_near_centre(x: Array, mu: Array, sigma: Array, out: Array) -> None:
    """With z = h + y and h in 26 bits, the exponent -h**2/2 - y (h + y/2) < 2 rounds once."""
    distance, lost = (x, None) if mu[0] == 0 else two_difference(x, mu)
    upper, lower = split(sigma)
    h = distance * (1 / sigma)
    h += _FINE
    h -= _FINE
    y = h * upper
    np.subtract(distance, y, out=y)
    if lower[0] != 0:
        y -= h * lower
    if lost is not None:
        y += lost
    y *= 1 / sigma
    np.multiply(y, 0.5, out=out)
    out += h
    out *= y
    h *= h
    h *= -0.5
    h -= out
    np.exp(h, out=out)
    out *= _PEAK / sigma


_QUANTUM = 1.5 * 2.0**32
"""Adding and taking away this rounds a number below 2**31 to a multiple of 2**-20."""


def _pdf_short(x: Array, mu: Array, sigma: Array) -> Array | None:
    """With z = h + y and h in 26 bits, h**2 is exact and the rest is a short series."""
    distance, lost = two_sum(x, -mu) if mu.any() else (x, 0.0)
    z = distance / sigma
    if not (z.max() < _SHORT and z.min() > -_SHORT):
        return None
    h = z + _QUANTUM
    h -= _QUANTUM
    upper, lower = split(sigma)
    y = (distance - h * upper) - h * lower + lost
    y /= sigma
    rest = y * (h + 0.5 * y)
    h *= h
    h *= -0.5
    value: Array = np.exp(h)
    value *= _PEAK / sigma
    rest *= 1 - rest * (0.5 - rest / 6)
    rest -= _PEAK_LOST
    value -= value * rest
    return value


_SHORT = 36.0


def _bell(distance: Array, lost: Array, sigma: Array, shift: Counts | None) -> Array:
    """Density of sigma 2**shift at distance 2**shift."""
    z = distance / sigma
    product, error = two_product(z, sigma)
    low = ((distance - product) - error + lost) / sigma
    beyond = np.abs(z) > 60
    if beyond.any():
        z, low = np.where(beyond, 60.0, z), np.where(beyond, 0.0, low)
    square, skew = two_product(z, z)
    skew += 2 * z * low
    correction = _PEAK_LOST - skew / 2
    if shift is None and square.max() < 1380:
        value = np.exp(square * -0.5) * _PEAK / sigma
        value += value * correction
        return value
    # In two halves, because exp would be subnormal before the division by sigma.
    half = np.exp(square * -0.25)
    value = half * _PEAK / sigma
    value += value * correction
    return (value if shift is None else np.ldexp(value, -shift)) * half


def interval(a: Array, b: Array) -> Array:
    """P(a < n < b) for a <= b."""
    a, b = np.broadcast_arrays(a, b)
    inner, outer = np.minimum(np.abs(a), np.abs(b)), np.maximum(np.abs(a), np.abs(b))
    one_sided = (a >= 0) | (b <= 0)
    return _either(one_sided, _one_sided, _around_centre, inner, outer)


def _either(flags: Flags, yes: Formula, no: Formula, *args: Array) -> Array:
    """One function where the flags are set, another one elsewhere."""
    if flags.all():
        result: Array = yes(*args)
        return result
    value = np.empty(flags.shape)
    for function, where in ((yes, np.flatnonzero(flags)), (no, np.flatnonzero(~flags))):
        if where.size:
            value[where] = function(*[arg.take(where) for arg in args])
    return value


def _around_centre(inner: Array, outer: Array) -> Array:
    return _from_centre(inner) + _from_centre(outer)


def _one_sided(a: Array, b: Array) -> Array:
    """P(a < n < b) for 0 <= a <= b: by quadrature unless the tail at b is much smaller."""
    near, far = np.minimum(a, 2 * _FAR), np.minimum(b, 4 * _FAR)
    width = far - near
    return _either(width * (near + width / 2) > 1, _tails, _narrow, near, far)


def _tails(near: Array, far: Array) -> Array:
    return _tail(near) - _tail(far)


def _narrow(near: Array, far: Array) -> Array:
    """The density at the near end times how it falls, which is by exp(1) at most."""
    width = far - near
    total = np.zeros_like(near)
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        t = width * (0.5 + 0.5 * node)
        total += 0.5 * weight * np.exp(-t * (near + t / 2))
    one = np.ones(1)
    return _bell(near, np.zeros(1), one, None) * width * total


_STEPS = 2
"""Halley steps from an error below 5e-4; each cubes it."""

_MIDDLE = 0.38


def inverse_tail(p: Array) -> Array:
    """Solve Q(k) = p, for the probability from the centre or the logarithm of the tail."""
    less = np.minimum(p, 1 - p)
    log = np.log(less)
    t = np.sqrt(-2 * log)  # the start is 26.2.23 of the handbook
    k = t - (2.515517 + t * (0.802853 + t * 0.010328)) / (
        1 + t * (1.432788 + t * (0.189269 + t * 0.001308))
    )
    np.maximum(k, 0.0, out=k)
    k = _either(less > 0.5 - _MIDDLE, _from_share, _from_log, k, less, log)
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


def determinant(s1: Array, s2: Array, rho: Array) -> Array:
    """Product s1**2 s2**2 (1 - rho**2)."""
    return _with_exponents(_one_minus_square(rho), s1, s2, power=2)


def peak(s1: Array, s2: Array, rho: Array) -> Array:
    """Largest density 1/(2 pi s1 s2 sqrt(1 - rho**2))."""
    root = np.sqrt(_one_minus_square(rho))
    (m1, e1), (m2, e2) = np.frexp(s1), np.frexp(s2)
    value = _FLAT_PEAK / (m1 * m2 * root)
    return np.ldexp(value, -(e1 + e2))


_FLAT_PEAK = 0.15915494309189535
"""1/(2 pi)."""


def _one_minus_square(rho: Array) -> Array:
    square, error = two_product(rho, rho)
    return (1 - square) - error


def _with_exponents(factor: Array, s1: Array, s2: Array, power: int) -> Array:
    (m1, e1), (m2, e2) = np.frexp(s1), np.frexp(s2)
    area = m1 * m2
    return np.ldexp(area * area * factor, power * (e1 + e2))
