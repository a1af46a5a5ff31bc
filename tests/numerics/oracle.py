"""Reference values: the textbook formulas in mpmath, at whatever precision settles 45 digits.

Nothing here computes with the code under test (the table of V(lambda) is read from it). ``reference(name, args)`` takes doubles, reads them as the
binary numbers they are, and returns an ``mpf`` with at least 45 correct digits.
"""

# ruff: noqa: N803 - mathematics and tables of inputs

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import mpmath as mp
from mpmath import mpf

from quizgen.numerics.luminosity import DAY


def reference(name, args, digits=45):
    """Raise the precision until two results agree to ``digits`` digits."""
    formula = FORMULAS[name]
    before = None
    for precision in (60, 120, 240, 480, 960, 1920, 3840):
        with mp.workdps(precision):
            result = formula(*[mpf(float(arg)) for arg in args])
            settled = before is not None and _agree(before, result, digits)
            if settled and (result != 0 or precision > 900):
                return result
            before = result
    raise ArithmeticError(f"{name}{args} does not settle")


def _agree(a, b, digits):
    if a == b:
        return True
    if mp.isinf(a) or mp.isinf(b):
        return False
    return abs(a - b) <= abs(b) * mpf(10) ** (-digits)


def upper_tail(k):
    if abs(k) > 1000:
        return mpf(k < 0)
    return mp.erfc(k / mp.sqrt(2)) / 2


def inverse_tail(p):
    """Newton on ln Q, in extended precision."""
    if p == mpf(1) / 2:
        return mpf(0)
    if p > mpf(1) / 2:
        return -inverse_tail(1 - p)
    k = mp.sqrt(-2 * mp.log(2 * p)) if p < mpf(2) / 5 else (mpf(1) / 2 - p) * mp.sqrt(2 * mp.pi)
    for _ in range(200):
        q = upper_tail(k)
        step = mp.log(q / p) * q * mp.sqrt(2 * mp.pi) * mp.exp(k * k / 2)
        k += step
        if abs(step) <= abs(k) * mpf(10) ** (5 - mp.mp.dps):
            return k
    raise ArithmeticError("no convergence")


def far_limit(f, N, c, s):
    gap = f * f - N * c * (s - f)
    return f * f * s / gap if gap > 0 else mp.inf


def fold_radius(k1, k2):
    """Of 1 + 3 k1 u + 5 k2 u^2: the reciprocals of its roots do not cancel where k2 is tiny."""
    inside = 9 * k1 * k1 - 20 * k2
    if inside < 0:
        return mp.inf
    inverses = [(-3 * k1 + sign * mp.sqrt(inside)) / 2 for sign in (1, -1)]
    return 1 / mp.sqrt(max(inverses)) if max(inverses) > 0 else mp.inf


def inverse_radius(d, k1, k2):
    """Bisection up to the fold, then Newton."""
    if d == 0:
        return mpf(0)
    fold = fold_radius(k1, k2)
    low, high = mpf(0), fold
    if mp.isinf(fold):
        high = d
        while high * (1 + k1 * high**2 + k2 * high**4) < d:
            high *= 2
    for _ in range(int(3.4 * mp.mp.dps) + 40):
        middle = (low + high) / 2
        if middle * (1 + k1 * middle**2 + k2 * middle**4) < d:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def distort(x, y, k1, k2):
    r2 = x * x + y * y
    return x * (1 + k1 * r2 + k2 * r2 * r2)


def channel(n):
    """One channel of HSV to RGB in the closed form f(n) = V - V S max(0, min(k, 4 - k, 1))."""

    def formula(H, S, V):
        k = (n + H / 60) % 6
        return V - V * S * max(mpf(0), min(k, 4 - k, mpf(1)))

    return formula


def as_decimal(value):
    """The decimal that a double prints as."""
    return Fraction(repr(float(value)))


def pixel(*args):
    """On the decimals that these doubles stand for, with fractions."""
    f, pitch, x, z, o = (as_decimal(float(arg)) for arg in args)
    u = o + f * x / (pitch * z)
    return mpf(u.numerator) / u.denominator


def poisson_pmf(k, lam):
    if lam == 0:
        return mpf(k == 0)
    return mp.exp(k * mp.log(lam) - lam - mp.loggamma(k + 1))


def poisson_lower(k, lam):
    """P(X <= k)."""
    return _regularised(k + 1, lam, lower=False)


def _regularised(a, x, *, lower):
    """Sum the terms of the smaller side one by one."""
    if x == 0:
        return mpf(0) if lower else mpf(1)
    start = mp.exp(a * mp.log(x) - x - mp.loggamma(a + 1))
    if x < a + 1:
        term, total, n = start, start, a
        while term > total * mpf(10) ** (-mp.mp.dps):
            n += 1
            term *= x / n
            total += term
        return total if lower else 1 - total
    term = start * a / x
    total, n = term, a
    while n > 1 and term > total * mpf(10) ** (-mp.mp.dps):
        n -= 1
        term *= n / x
        total += term
    return 1 - total if lower else total


def encode(x):
    return x ** (mpf(5) / 11) if x else mpf(0)


def gap(a, b):
    return encode((a + b) / 2) - (encode(a) + encode(b)) / 2


def srgb_decode(x):
    if x <= mpf("0.04045"):
        return x / mpf("12.92")
    return ((x + mpf("0.055")) / mpf("1.055")) ** (mpf(12) / 5)


def table():
    """V(lambda) of CIE 1924, read as the decimals of the table: wavelength and value."""
    return [
        (mpf(DAY.first + DAY.step * i), mpf(repr(v))) for i, v in enumerate(DAY.values.tolist())
    ]


def segments():
    return pairwise(table())


def photopic(wavelength):
    for (x0, v0), (x1, v1) in segments():
        if x0 <= wavelength <= x1:
            return v0 + (v1 - v0) * (wavelength - x0) / (x1 - x0)
    return mpf(0)


FORMULAS = {
    "gaussian.upper_tail": upper_tail,
    "gaussian.two_sided_tail": lambda k: mp.erfc(k / mp.sqrt(2)) if k > 0 else mpf(1),
    "gaussian.inverse_upper_tail": inverse_tail,
    "depth_of_field.far_limit": far_limit,
    "distortion.distort_x": distort,
    "distortion.inverse_radius": inverse_radius,
    "distortion.fold_radius": fold_radius,
    "hsv.red": channel(5),
    "hsv.green": channel(3),
    "hsv.blue": channel(1),
    "projection.pixel_coordinate": pixel,
    "poisson.pmf": poisson_pmf,
    "poisson.lower": poisson_lower,
    "gamma.gap": gap,
    "gamma.srgb_decode": srgb_decode,
    "luminosity.luminous_efficiency": photopic,
}
