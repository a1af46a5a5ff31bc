"""Special functions on exact values: rational where that is so, else certified balls.

Run them under ``working_precision``. Any of them raises ``MathError`` where there is no finite real
value, and ``UndecidedError`` where a ball does not settle it. Quantiles are roots of their
distribution function: found in floats, made sharp by Newton's method, and proved by the
distribution function on either side.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from flint import arb, ctx, fmpq, fmpz

from quizgen.core.errors import MathError, UndecidedError
from quizgen.maths.values import Value

LARGEST_FACTORIAL = 1000
"""Largest argument whose factorial is computed as a whole number."""
LARGEST_DEGREES = 10**6
"""Largest number of degrees of freedom."""
_NEWTON_STEPS = 12
_WIDENINGS = 8


def _to_ball(a: Value) -> arb:
    """Return a value as a ball that encloses it, at the working precision if it was exact."""
    return a if isinstance(a, arb) else arb(a)


def _require_value(x: arb) -> arb:
    """Return a ball; ``MathError`` if it is not finite."""
    if not x.is_finite():
        raise MathError("no finite real value")
    return x


def _convert_to_integer(a: Value) -> int | None:
    """Return a value as an integer; None if it is none, or is not known exactly."""
    return int(a.p) if isinstance(a, fmpq) and a.q == 1 else None


def sinh(a: Value) -> Value:
    """Return the hyperbolic sine; 0 for 0."""
    return fmpq(0) if a == 0 else _require_value(_to_ball(a).sinh())


def cosh(a: Value) -> Value:
    """Return the hyperbolic cosine; 1 for 0."""
    return fmpq(1) if a == 0 else _require_value(_to_ball(a).cosh())


def tanh(a: Value) -> Value:
    """Return the hyperbolic tangent; 0 for 0."""
    return fmpq(0) if a == 0 else _require_value(_to_ball(a).tanh())


def factorial(a: Value) -> Value:
    """Return the factorial: whole for a whole number, else the gamma function of one more."""
    n = _convert_to_integer(a)
    if n is not None and n < 0:
        raise MathError("factorial of a negative whole number")
    if n is not None and n <= LARGEST_FACTORIAL:
        return fmpq(fmpz.fac_ui(n))
    return _require_value((_to_ball(a) + 1).gamma())


def gamma(a: Value) -> Value:
    """Return the gamma function; a whole number for a whole number."""
    n = _convert_to_integer(a)
    return _require_value(_to_ball(a).gamma()) if n is None or n <= 0 else factorial(fmpq(n - 1))


def binomial(n: Value, k: Value) -> Value:
    """Return the binomial coefficient; a rational where ``k`` is a whole number."""
    chosen = _convert_to_integer(k)
    if chosen is None:
        top, below = _to_ball(n) + 1, _to_ball(k) + 1
        return _require_value(top.gamma() / below.gamma() / (top - below + 1).gamma())
    if chosen > LARGEST_FACTORIAL:
        raise MathError("binomial coefficient of too large a number")
    result: Value = fmpq(1 if chosen >= 0 else 0)
    for i in range(chosen):
        result = result * (n - i) / (i + 1)
    return result


def beta(a: Value, b: Value) -> Value:
    """Return the beta function; a rational for two positive whole numbers."""
    m, n = _convert_to_integer(a), _convert_to_integer(b)
    if m is not None and n is not None and 0 < m < LARGEST_FACTORIAL > n > 0:
        return gamma(a) * gamma(b) / gamma(a + b)
    x, y = _to_ball(a), _to_ball(b)
    return _require_value(x.gamma() * y.gamma() * (x + y).rgamma())


def erfinv(a: Value) -> Value:
    """Return the inverse of the error function; 0 for 0."""
    return fmpq(0) if a == 0 else _require_value(_to_ball(a).erfinv())


def lambertw(a: Value) -> Value:
    """Return Lambert's W, its principal branch; 0 for 0."""
    return fmpq(0) if a == 0 else _require_value(_to_ball(a).lambertw())


def lowergamma(s: Value, x: Value) -> arb:
    """Return the integral of t^(s-1) e^-t from 0 to ``x``: not divided by gamma of ``s``."""
    return _require_value(_to_ball(x).gamma_lower(_to_ball(s)))


def uppergamma(s: Value, x: Value) -> arb:
    """Return the integral of t^(s-1) e^-t from ``x`` on: not divided by gamma of ``s``."""
    return _require_value(_to_ball(x).gamma_upper(_to_ball(s)))


def _make_bessel(method: str) -> Callable[[Value, Value], arb]:
    """Return a Bessel function (order, x) from the name of FLINT's method."""

    def apply(order: Value, x: Value) -> arb:
        """Return the value of the Bessel function; ``MathError`` if it is not finite."""
        return _require_value(getattr(_to_ball(x), method)(_to_ball(order)))

    return apply


bessel_first_kind = _make_bessel("bessel_j")
bessel_second_kind = _make_bessel("bessel_y")
bessel_modified_first_kind = _make_bessel("bessel_i")
bessel_modified_second_kind = _make_bessel("bessel_k")


# Distribution functions


def _require_degrees(n: Value) -> arb:
    """Return degrees of freedom as a ball; ``MathError`` if not from 0 to the largest."""
    if not 0 < n <= LARGEST_DEGREES:
        raise MathError(f"degrees of freedom must be positive, and at most {LARGEST_DEGREES}")
    return _to_ball(n)


def normal_cdf(z: Value) -> Value:
    """Share of the standard normal distribution up to ``z``."""
    return fmpq(1, 2) if z == 0 else _require_value((-_to_ball(z) / arb(2).sqrt()).erfc() / 2)


def t_cdf(t: Value, n: Value) -> Value:
    """Share of Student's distribution with ``n`` degrees of freedom up to ``t``."""
    degrees = _require_degrees(n)
    if t == 0:
        return fmpq(1, 2)
    x = _to_ball(t)
    tail = _compute_regularized_beta(degrees / (degrees + x * x), degrees / 2, arb(1) / 2) / 2
    if t > 0:
        return 1 - tail
    if t < 0:
        return tail
    raise UndecidedError("sign cannot be certified")


def chi2_cdf(x: Value, n: Value) -> Value:
    """Share of the chi-squared distribution with ``n`` degrees of freedom up to ``x``."""
    degrees = _require_degrees(n)
    if x <= 0:
        return fmpq(0)
    return _require_value((_to_ball(x) / 2).gamma_lower(degrees / 2, regularized=1))


def f_cdf(x: Value, m: Value, n: Value) -> Value:
    """Share of the F distribution with ``m`` and ``n`` degrees of freedom up to ``x``."""
    top, below = _require_degrees(m), _require_degrees(n)
    if x <= 0:
        return fmpq(0)
    y = _to_ball(x)
    return _compute_regularized_beta(top * y / (top * y + below), top / 2, below / 2)


def _compute_regularized_beta(x: arb, a: arb, b: arb) -> arb:
    """Return the regularized incomplete beta function I_x(a, b)."""
    return _require_value(x.beta_lower(a, b, regularized=True))


# Quantiles


def normal_quantile(p: Value) -> Value:
    """Return where the standard normal distribution reaches the share ``p``."""
    _require_share(p)
    if p == fmpq(1, 2):
        return fmpq(0)
    return _require_value(arb(2).sqrt() * (2 * _to_ball(p) - 1).erfinv())


def t_quantile(p: Value, n: Value) -> Value:
    """Return where Student's distribution with ``n`` degrees of freedom reaches the share ``p``."""
    _require_share(p)
    _require_degrees(n)
    if p == fmpq(1, 2):
        return fmpq(0)
    return _find_quantile("t", p, (n,), ctx.prec)


def chi2_quantile(p: Value, n: Value) -> Value:
    """Return where the chi-squared distribution reaches the share ``p``."""
    _require_share(p)
    _require_degrees(n)
    return _find_quantile("chi2", p, (n,), ctx.prec)


def f_quantile(p: Value, m: Value, n: Value) -> Value:
    """Return where the F distribution reaches the share ``p``."""
    _require_share(p)
    _require_degrees(m)
    _require_degrees(n)
    return _find_quantile("f", p, (m, n), ctx.prec)


def _require_share(p: Value) -> None:
    """Raise ``MathError`` unless a share lies strictly between 0 and 1."""
    if not 0 < p < 1:
        raise MathError("a quantile needs a share between 0 and 1")


_DISTRIBUTIONS: dict[str, tuple[Callable[..., Value], bool]] = {
    "t": (t_cdf, True),
    "chi2": (chi2_cdf, False),
    "f": (f_cdf, False),
}
"""Distribution function, and whether it goes down to minus infinity."""


def _find_quantile(name: str, p: Value, degrees: tuple[Value, ...], precision: int) -> arb:
    """Return the quantile of a distribution; for rational arguments it is found once."""
    if all(isinstance(value, fmpq) for value in (p, *degrees)):
        parts = [(int(value.p), int(value.q)) for value in (p, *degrees)]
        return _find_exact_quantile(name, tuple(parts), precision)
    return _solve_quantile(name, p, degrees)


@lru_cache(maxsize=4096)
def _find_exact_quantile(name: str, parts: tuple[tuple[int, int], ...], precision: int) -> arb:
    """Return the quantile for rational arguments, cached by precision as well."""
    del precision  # the one in force; a part of the key of the cache
    p, *degrees = (fmpq(top, bottom) for top, bottom in parts)
    return _solve_quantile(name, p, tuple(degrees))


def _solve_quantile(name: str, p: Value, degrees: tuple[Value, ...]) -> arb:
    """Return a root of the distribution function, in a ball that is proved to hold it."""
    function, signed = _DISTRIBUTIONS[name]

    def share(x: arb) -> arb:
        """Return the share below x, the value of the distribution function."""
        return _to_ball(function(x, *degrees))

    guess = arb(_bisect(lambda x: share(arb(x)), float(_to_ball(p)), signed=signed))
    root = _sharpen(share, _to_ball(p), guess)
    width = (abs(root) + arb(2) ** -20) * arb(2) ** (16 - ctx.prec)
    for _ in range(_WIDENINGS):
        if share(root - width) < p < share(root + width):
            return root + arb(0, 1) * width
        width = width * 64
    raise UndecidedError("the quantile cannot be certified")


def _bisect(share: Callable[[float], Any], p: float, *, signed: bool) -> float:
    """Return roughly the place where a growing share reaches p, by bisection in floats.

    ``signed`` if it may be negative. The result is where the certified search starts.
    """
    low, high = (-1.0 if signed else 0.0), 1.0
    while share(high) < p and math.isfinite(high):
        high *= 2
    while signed and share(low) > p and math.isfinite(low):
        low *= 2
    for _ in range(200):
        middle = (low + high) / 2
        if not low < middle < high:
            break
        if share(middle) < p:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def _sharpen(share: Callable[[arb], arb], p: arb, root: arb) -> arb:
    """Return a root by secants from two near points: each adds half as many digits again."""
    before = root * (1 + arb(2) ** -30)
    off, off_before = (share(root) - p).mid(), (share(before) - p).mid()
    for _ in range(_NEWTON_STEPS):
        slope = (off - off_before) / (root - before)
        if slope.contains(0) or off == 0:
            break
        before, off_before = root, off
        root = (root - off / slope).mid()
        off = (share(root) - p).mid()
    return root
