"""Depth of field of a thin lens: hyperfocal distance, near and far limit, total depth.

Source: the distances at which the blur disc of the thin lens equals c, in closed form with
A = f**2 and B = N c (s - f); no image distance occurs, so nothing cancels but A - B.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache

import numpy as np

from quizgen.arrays.aliases import Array, Blocks, Flags, Numbers, Result
from quizgen.arrays.domain import POSITIVE, Rule
from quizgen.arrays.double_double import Double, Number, Pair, pairs, two_product, two_sum
from quizgen.arrays.kernel import Exactly, Kernel, Short, filled
from quizgen.arrays.rational import nearest

Ratios = tuple[Double, Double, Double]
"""A/(2 N c) and what rounding it lost, and N c/A, for one camera or for many."""

_CLOSE = 2.0**-40
"""Relative distance from the hyperfocal distance below which A - B is settled exactly."""


def _hyperfocal(f: Number, N: Number, c: Number) -> Number:
    return f * f / (N * c) + f


def _near(f: Number, N: Number, c: Number, s: Number) -> Number:
    A = f * f
    return A * s / (A + N * c * (s - f))


def _far(f: Number, N: Number, c: Number, s: Number) -> Number:
    A = f * f
    return A * s / (A - N * c * (s - f))


def _total(f: Number, N: Number, c: Number, s: Number) -> Number:
    A, B = f * f, N * c * (s - f)
    return 2 * s * A * B / ((A - B) * (A + B))


def _gap(f: Array, N: Array, c: Array, s: Array) -> Array:
    """(A - B)/A: positive below the hyperfocal distance."""
    return 1 - N * (s - f) * c / (f * f)


def _limited(formula: Callable[..., Pair]) -> Callable[..., tuple[Array, Flags]]:
    """Infinity at or beyond the hyperfocal distance; doubtful next to it."""

    def compute(f: Array, N: Array, c: Array, s: Array) -> tuple[Array, Flags]:
        gap = _gap(f, N, c, s)
        value = formula(*pairs(f, N, c, s)).rounded()
        return np.where(gap > 0, value, math.inf), np.abs(gap) < _CLOSE

    return compute


def _share(f: Array, N: Array, c: Array, s: Array) -> Array:
    """Distance in focus in hyperfocal distances, q = N c (s - f)/f**2."""
    return (N * c / (f * f)) * (s - f)


def _far_short(f: Array, N: Array, c: Array, s: Array) -> Array:
    q = _share(f, N, c, s)
    return _or_long(s / (1 - q), q, 0.3, _FAR, (f, N, c, s))


def _near_short(f: Array, N: Array, c: Array, s: Array, out: Array) -> None:
    q = _share(f, N, c, s)
    if q.max() < 0.7:
        np.add(q, 1, out=out)
        np.divide(s, out, out=out)
    else:
        out[...] = _or_long(s / (1 + q), q, 0.7, _NEAR, (f, N, c, s))


_LEAST = 2.0**-900


def _total_short(f: Array, N: Array, c: Array, s: Array, out: Array) -> None:
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
        close = [np.take(arg, where) if np.size(arg) > 1 else arg for arg in ratios]
        out[where], doubtful = _total_close(s.take(where), way.take(where), *close)
        rest = where[doubtful]
        if rest.size:
            args = [arg.take(rest) if arg.size > 1 else arg for arg in (f, N, c, s)]
            out[rest] = _TOTAL.carefully(args)


_BEYOND = 1.001
_PLAIN = 0.45
"""Share of the hyperfocal distance up to which 1 - q**2 adds at most one unit of error."""


def _total_plain(s: Array, way: Array, ratios: Ratios, out: Array) -> None:
    """Quotient s w/(A/(2 N c) - N c w**2/(2 A)), w = s - f: three roundings that count."""
    ratio, rest, share = ratios
    below = way * way
    below *= share / 2
    below -= rest
    np.subtract(ratio, below, out=below)
    np.multiply(s, way, out=out)
    out /= below


def _total_close(
    s: Array, way: Array, ratio: Double, rest: Double, share: Double
) -> tuple[Array, Flags]:
    """Quotient s w/((2 r - w)(1 + q)/2), r = A/(2 N c): the difference keeps its digits."""
    gap = (2 * ratio - way) + 2 * rest
    below = gap * (0.5 + 0.5 * (way * share))
    with_limit = gap > 0
    value = s * way / np.where(with_limit, below, 1.0)
    return np.where(with_limit, value, math.inf), np.abs(gap) < _CLOSE * way


@lru_cache(maxsize=64)
def _ratios(f: float, N: float, c: float) -> tuple[float, float, float]:
    """The ratios of one camera."""
    half = Fraction(f) ** 2 / (2 * Fraction(N) * Fraction(c))
    ratio = nearest(half)
    return ratio, nearest(half - Fraction(ratio)), nearest(1 / (2 * half))


def _all_ratios(f: Array, N: Array, c: Array) -> Ratios:
    """The ratios of many cameras."""
    below = Pair(*two_product(N, c))
    top = Pair(f * f) if _squares_are_exact(f) else pairs(f)[0] * f
    half = top / below
    half.high *= 0.5
    half.low *= 0.5
    return half.high, half.low, 0.5 / half.high


def _squares_are_exact(f: Array) -> bool:
    return float(f.max()) < 2.0**26 and bool((np.rint(f) == f).all())


def _total_balanced(f: Array, N: Array, c: Array, s: Array) -> Array:
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


def _or_long(value: Array, q: Array, limit: float, kernel: Kernel, args: Blocks) -> Array:
    """Replace elements closer to the hyperfocal distance by the careful way."""
    if q.max() < limit:
        return value
    where = np.flatnonzero(q >= limit)
    some = [arg.take(where) if arg.size > 1 else arg for arg in args]
    value[where] = kernel.carefully(some)
    return value


def _limited_exact(formula: Callable[..., Fraction]) -> Callable[..., Fraction | float]:
    def exact(f: Fraction, N: Fraction, c: Fraction, s: Fraction) -> Fraction | float:
        return formula(f, N, c, s) if N * c * (s - f) < f * f else math.inf

    return exact


def _plain(formula: Callable[..., Pair]) -> Callable[..., tuple[Array, None]]:
    return lambda *args: (formula(*pairs(*args)).rounded(), None)


_RULES = (Rule("no-real-image", lambda f, _N, _c, s: s < f, lambda f, _N, _c, s: s[0] < f[1]),)
_HYPERFOCAL = Kernel(
    _plain(_hyperfocal),
    (POSITIVE,) * 3,
    exact=Exactly(_hyperfocal),
    short=Short(filled(lambda f, N, c: f * (f / (N * c)) + f)),
)
_NEAR = Kernel(
    _plain(_near), (POSITIVE,) * 4, _RULES, exact=Exactly(_near), short=Short(_near_short)
)
_FAR = Kernel(
    _limited(_far),
    (POSITIVE,) * 4,
    _RULES,
    exact=Exactly(_limited_exact(_far)),
    short=Short(filled(_far_short)),
)
_TOTAL = Kernel(
    _limited(_total),
    (POSITIVE,) * 4,
    _RULES,
    exact=Exactly(_limited_exact(_total)),
    short=Short(_total_short),
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
        ``no-real-image`` (s < f).
    """
    return _NEAR(f, N, c, s)


def far_limit(f: Numbers, N: Numbers, c: Numbers, s: Numbers) -> Result:
    """Farthest distance that is still sharp; infinity at or beyond the hyperfocal distance.

    Arguments and errors as ``near_limit``; s or more. Whether s reaches the hyperfocal distance is
    decided exactly.
    """
    return _FAR(f, N, c, s)


def total_depth(f: Numbers, N: Numbers, c: Numbers, s: Numbers) -> Result:
    """Depth of field, far limit minus near limit, without subtracting them.

    Arguments and errors as ``near_limit``; infinity at or beyond the hyperfocal distance.
    """
    return _TOTAL(f, N, c, s)
