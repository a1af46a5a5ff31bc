"""Rungs and oracles of families that are solved by iteration or need the gamma function."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from quizgen.tradeoff.families import Family
from quizgen.tradeoff.rung import DIGITS, Column, Inputs, Row, Rung, Value, ball_value, to_float


def _left(r: Value, r_d: Value, k1: Value) -> Value:
    """How far r is from the solution of r + k1 r**3 = r_d, in any number system."""
    return r * (1 + k1 * r * r) - r_d


def fixed_point(r_d: Value, k1: Value, count: int) -> Value:
    """Repeat r := r_d/(1 + k1 r**2), as OpenCV does it."""
    r = r_d
    for _ in range(count):
        r = r_d / (1 + k1 * r * r)
    return r


def newton(r_d: Value, k1: Value, count: int) -> Value:
    """Newton's method on r + k1 r**3 - r_d, started at r_d."""
    r = r_d
    for _ in range(count):
        r = r - _left(r, r_d, k1) / (1 + 3 * k1 * r * r)
    return r


def _inverse_rungs(family: Family) -> list[Rung]:
    del family
    return [
        Rung("float32", "array", lambda r, k, _: fixed_point(r, k, 5), _to(np.float32)),
        Rung("float64", "array", lambda r, k, _: fixed_point(r, k, 5), _to(np.float64)),
        Rung("fixed-20", "array", lambda r, k, _: fixed_point(r, k, 20), _to(np.float64)),
        Rung("newton-10", "array", lambda r, k, _: newton(r, k, 10), _to(np.float64)),
        Rung("arb", "scalar", lambda row: _inverse_ball(row, 63), tuple, to_float),
        Rung("mpmath", "scalar", lambda row: _inverse_precise(row, DIGITS), tuple, float),
        Rung("sympy", "scalar", _inverse_symbolic, tuple, float),
    ]


def _to(number: type[np.floating[Any]]) -> Callable[[Column], Column]:
    return lambda column: column.astype(number)


def _inverse_ball(row: Row, wanted: int = 200) -> Value:
    """Closed form of the cubic with balls: 2/sqrt(-3 k1) sin(asin(r_d/fold)/3)."""

    def closed_form(env: Inputs) -> Value:
        size = (-3 * env["k1"]).sqrt()
        return 2 / size * ((3 * size * env["r_d"] / 2).asin() / 3).sin()

    return ball_value(closed_form, {"r_d": row[0], "k1": row[1]}, wanted)


def _inverse_precise(row: Row, digits: int = 80) -> Value:
    """Newton's method from below; the iteration is monotone up to the fold."""
    import mpmath as mp

    with mp.workdps(digits + 15):
        r_d, k1 = mp.mpf(row[0]), mp.mpf(row[1])
        r = r_d
        for _ in range(300):
            step = _left(r, r_d, k1) / (1 + 3 * k1 * r * r)
            r -= step
            if abs(step) < abs(r) * mp.mpf(10) ** (-digits):
                break
        return r


def _inverse_symbolic(row: Row) -> Value:
    import sympy

    r = sympy.Symbol("r")
    r_d, k1 = sympy.Rational(row[0]), sympy.Rational(row[1])
    return sympy.nsolve(_left(r, r_d, k1), r, row[0], prec=DIGITS, verify=False)


def _poisson_rungs(family: Family) -> list[Rung]:
    del family
    gamma = _log_gamma()

    def textbook(k: Column, lam: Column) -> Column:
        return np.exp(k * np.log(lam) - lam - gamma(k + 1).astype(k.dtype))

    return [
        Rung("float32", "array", textbook, _to(np.float32)),
        Rung("float64", "array", textbook, _to(np.float64)),
        Rung("arb", "scalar", lambda row: _poisson_ball(row, 63), tuple, to_float),
        Rung("mpmath", "scalar", lambda row: _poisson_precise(row, DIGITS), tuple, float),
        Rung("sympy", "scalar", _poisson_symbolic, tuple, float),
    ]


def _poisson_symbolic(row: Row) -> Value:
    import sympy

    # Floats, because SymPy would write the gamma function of a whole number out as a factorial.
    k, lam = (sympy.Float(value, DIGITS + 20) for value in row)
    return sympy.exp(k * sympy.log(lam) - lam - sympy.loggamma(k + 1))


def _log_gamma() -> Callable[[Column], Column]:
    try:
        import scipy.special
    except ImportError:
        return np.vectorize(math.lgamma, otypes=[np.float64])
    function: Callable[[Column], Column] = scipy.special.gammaln
    return function


def _poisson_ball(row: Row, wanted: int = 200) -> Value:

    def pmf(env: Inputs) -> Value:
        k, lam = env["k"], env["lam"]
        return (k * lam.log() - lam - (k + 1).lgamma()).exp()

    return ball_value(pmf, {"k": row[0], "lam": row[1]}, wanted)


def _poisson_precise(row: Row, digits: int = 80) -> Value:
    import mpmath as mp

    with mp.workdps(digits + 20):
        k, lam = mp.mpf(row[0]), mp.mpf(row[1])
        return mp.exp(k * mp.log(lam) - lam - mp.loggamma(k + 1))


RUNGS: dict[str, Callable[[Family], list[Rung]]] = {
    "inverse-distortion": _inverse_rungs,
    "poisson": _poisson_rungs,
}

ORACLES: dict[str, tuple[Callable[..., Any], Callable[..., Any]]] = {
    "inverse-distortion": (_inverse_ball, _inverse_precise),
    "poisson": (_poisson_ball, _poisson_precise),
}
