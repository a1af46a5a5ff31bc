"""Depth of field of a thin lens: hyperfocal distance, near and far limit, total depth.

Source: the distances at which the blur disc of the thin lens equals c, in closed form with
A = f**2 and B = N c (s - f); no image distance occurs, so nothing cancels but A - B.
"""

from __future__ import annotations

import math
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from quizgen.arrays.domain import POSITIVE, Kernel, Numbers, Result, Rule, exactly, filled, nearest
from quizgen.arrays.double_double import Pair, pairs, two_product, two_sum

_CLOSE = 2.0**-40
"""Relative distance from the hyperfocal distance below which A - B is settled exactly."""


def _hyperfocal(f: Any, N: Any, c: Any) -> Any:
    return f * f / (N * c) + f


def _near(f: Any, N: Any, c: Any, s: Any) -> Any:
    A = f * f
    return A * s / (A + N * c * (s - f))


def _far(f: Any, N: Any, c: Any, s: Any) -> Any:
    A = f * f
    return A * s / (A - N * c * (s - f))


def _total(f: Any, N: Any, c: Any, s: Any) -> Any:
    A, B = f * f, N * c * (s - f)
    return 2 * s * A * B / ((A - B) * (A + B))


def _gap(f: Any, N: Any, c: Any, s: Any) -> Any:
    """(A - B)/A: positive below the hyperfocal distance."""
    return 1 - N * (s - f) * c / (f * f)


def _limited(formula: Any) -> Any:
    """Infinity at or beyond the hyperfocal distance; doubtful next to it."""

    def compute(f: Any, N: Any, c: Any, s: Any) -> Any:
        gap = _gap(f, N, c, s)
        value = formula(*pairs(f, N, c, s)).rounded()
        return np.where(gap > 0, value, math.inf), np.abs(gap) < _CLOSE

    return compute


def _share(f: Any, N: Any, c: Any, s: Any) -> Any:
    """Distance in focus in hyperfocal distances, q = N c (s - f)/f**2."""
    return (N * c / (f * f)) * (s - f)


def _far_short(f: Any, N: Any, c: Any, s: Any) -> Any:
    q = _share(f, N, c, s)
    return _or_long(s / (1 - q), q, 0.3, _FAR, (f, N, c, s))


def _near_short(f: Any, N: Any, c: Any, s: Any, out: Any) -> None:
    q = _share(f, N, c, s)
    if q.max() < 0.7:
        np.add(q, 1, out=out)
        np.divide(s, out, out=out)
    else:
        out[...] = _or_long(s / (1 + q), q, 0.7, _NEAR, (f, N, c, s))


_LEAST = 2.0**-900


def _total_short(f: Any, N: Any, c: Any, s: Any, out: Any) -> None:
    """By the shortest way that keeps its digits."""
    way = s - f
    lost = s - way
    lost -= f
    if lost.any():
        out[...] = _total_balanced(f, N, c, s)
        return
    one = f.size == N.size == c.size == 1
    if not one:
        f, N, c, s, way = np.broadcast_arrays(f, N, c, s, way)
    ratios = _ratios(f.item(), N.item(), c.item()) if one else _all_ratios(f, N, c)
    _total_plain(s, way, ratios, out)
    share = ratios[2]
    if way.max() * np.max(share) > _PLAIN:
        q = way * share
        out[q > _BEYOND] = math.inf
        where = np.flatnonzero((q > _PLAIN) & (q <= _BEYOND))
        some = [arg.take(where) if np.size(arg) > 1 else arg for arg in (s, way, *ratios)]
        out[where], doubtful = _total_close(*some)
        for i in where[doubtful]:
            out[i] = _settled(_TOTAL, (f, N, c, s), i)


_BEYOND = 1.001
_PLAIN = 0.45
"""Share of the hyperfocal distance up to which 1 - q**2 adds at most one unit of error."""


def _total_plain(s: Any, way: Any, ratios: tuple[Any, Any, Any], out: Any) -> None:
    """Quotient s w/(A/(2 N c) - N c w**2/(2 A)), w = s - f: three roundings that count."""
    ratio, rest, share = ratios
    below = way * way
    below *= share / 2
    below -= rest
    np.subtract(ratio, below, out=below)
    np.multiply(s, way, out=out)
    out /= below


def _total_close(s: Any, way: Any, ratio: Any, rest: Any, share: Any) -> tuple[Any, Any]:
    """Quotient s w/((2 r - w)(1 + q)/2), r = A/(2 N c): the difference keeps its digits."""
    gap = (2 * ratio - way) + 2 * rest
    below = gap * (0.5 + 0.5 * (way * share))
    with_limit = gap > 0
    value = s * way / np.where(with_limit, below, 1.0)
    return np.where(with_limit, value, math.inf), np.abs(gap) < _CLOSE * way


@lru_cache(maxsize=64)
def _ratios(f: float, N: float, c: float) -> tuple[float, float, float]:
    """A/(2 N c) and what rounding it lost, and N c/A."""
    half = Fraction(f) ** 2 / (2 * Fraction(N) * Fraction(c))
    ratio = nearest(half)
    return ratio, nearest(half - Fraction(ratio)), nearest(1 / (2 * half))


def _all_ratios(f: Any, N: Any, c: Any) -> tuple[Any, Any, Any]:
    """The same for many cameras."""
    below = Pair(*two_product(N, c))
    top = Pair(f * f) if _squares_are_exact(f) else pairs(f)[0] * f
    half = top / below
    half.high *= 0.5
    half.low *= 0.5
    return half.high, half.low, 0.5 / half.high


def _squares_are_exact(f: Any) -> bool:
    return float(f.max()) < 2.0**26 and bool((np.rint(f) == f).all())


def _total_balanced(f: Any, N: Any, c: Any, s: Any) -> Any:
    """2 s q/(1 - q**2), with what rounding N c/f**2 lost put back."""
    f_pair, N_pair, c_pair = pairs(f, N, c)
    rate = N_pair * c_pair / (f_pair * f_pair)
    way, way_lost = two_sum(s, -f)
    q, lost = two_product(way, rate.high)
    lost += way * rate.low
    lost += way_lost * rate.high
    value = 2 * s * q / (1 - q * q)
    value += value * (lost / np.maximum(q, _LEAST))
    return _or_long(value, q, 0.6, _TOTAL, (f, N, c, s))


def _or_long(value: Any, q: Any, limit: float, kernel: Kernel, args: Any) -> Any:
    """Replace elements closer to the hyperfocal distance by the careful way."""
    if q.max() < limit:
        return value
    where = np.flatnonzero(q >= limit)
    some = [arg.take(where) if arg.size > 1 else arg for arg in args]
    careful, doubtful = kernel.compute(*some)
    value[where] = careful
    if doubtful is not None and doubtful.any():
        rest = where[doubtful]
        value[rest] = [_settled(kernel, args, i) for i in rest]
    return value


def _settled(kernel: Kernel, args: Any, i: int) -> float:
    exact: Any = kernel.exact
    return nearest(exact(*exactly(args, i)))


def _limited_exact(formula: Any) -> Any:
    def exact(f: Any, N: Any, c: Any, s: Any) -> Any:
        return formula(f, N, c, s) if N * c * (s - f) < f * f else math.inf

    return exact


def _plain(formula: Any) -> Any:
    return lambda *args: (formula(*pairs(*args)).rounded(), None)


_RULES = (Rule("no-real-image", lambda f, _N, _c, s: s < f, lambda f, _N, _c, s: s[0] < f[1]),)
_HYPERFOCAL = Kernel(
    _plain(_hyperfocal),
    (POSITIVE,) * 3,
    exact=_hyperfocal,
    fast=filled(lambda f, N, c: f * (f / (N * c)) + f),
)
_NEAR = Kernel(_plain(_near), (POSITIVE,) * 4, _RULES, exact=_near, fast=_near_short)
_FAR = Kernel(
    _limited(_far),
    (POSITIVE,) * 4,
    _RULES,
    exact=_limited_exact(_far),
    fast=filled(_far_short),
)
_TOTAL = Kernel(
    _limited(_total),
    (POSITIVE,) * 4,
    _RULES,
    exact=_limited_exact(_total),
    fast=_total_short,
)


def hyperfocal(f: Numbers, N: Numbers, c: Numbers) -> Result:
    """Hyperfocal distance H = f**2/(N c) + f.

    Parameters
    ----------
    f, N, c : array_like
        Focal length, f-number, largest blur disc still called sharp; all > 0, f and c in the
        same unit.

    Returns
    -------
    float or array
        Unit of f.

    Raises
    ------
    DomainError
        ``not-positive``, ``not-finite`` (arrays: masked).
    """
    return _HYPERFOCAL(f, N, c)


def near_limit(f: Numbers, N: Numbers, c: Numbers, s: Numbers) -> Result:
    """Nearest distance that is still sharp, f**2 s/(f**2 + N c (s - f)).

    Parameters
    ----------
    f, N, c, s : array_like
        As for ``hyperfocal``; s >= f is the distance in focus.

    Returns
    -------
    float or array
        Unit of f, between f and s.

    Raises
    ------
    DomainError
        ``no-real-image`` (s < f), ``not-positive``, ``not-finite`` (arrays: masked).
    """
    return _NEAR(f, N, c, s)


def far_limit(f: Numbers, N: Numbers, c: Numbers, s: Numbers) -> Result:
    """Farthest distance that is still sharp; infinity at or beyond the hyperfocal distance.

    Parameters
    ----------
    f, N, c, s : array_like
        As for ``near_limit``.

    Returns
    -------
    float or array
        Unit of f, s or more. Whether s reaches the hyperfocal distance is decided exactly.

    Raises
    ------
    DomainError
        ``no-real-image`` (s < f), ``not-positive``, ``not-finite`` (arrays: masked).
    """
    return _FAR(f, N, c, s)


def total_depth(f: Numbers, N: Numbers, c: Numbers, s: Numbers) -> Result:
    """Depth of field, far limit minus near limit, without subtracting them.

    Parameters
    ----------
    f, N, c, s : array_like
        As for ``near_limit``.

    Returns
    -------
    float or array
        Unit of f; infinity at or beyond the hyperfocal distance.

    Raises
    ------
    DomainError
        ``no-real-image`` (s < f), ``not-positive``, ``not-finite`` (arrays: masked).
    """
    return _TOTAL(f, N, c, s)
