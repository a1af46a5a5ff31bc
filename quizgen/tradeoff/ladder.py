"""Rungs: the same formula in different number systems, and the truth to judge them by."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from flint import fmpq

from quizgen.arrays.aliases import Array
from quizgen.arrays.double_double import Pair
from quizgen.errors import QuizgenError
from quizgen.maths.numbers import rational
from quizgen.maths.systems import arrays, compile_expr, exact, multiprecision, symbolic
from quizgen.maths.tree import Expr
from quizgen.tradeoff.families import Family
from quizgen.tradeoff.pairs import fits_pairs, pairs
from quizgen.tradeoff.rung import DIGITS, Column, Inputs, Rung, Value, ball_value, to_float
from quizgen.tradeoff.special import ORACLES, RUNGS

ORACLE_BITS = 200
ORACLE_DIGITS = 80
AGREEMENT = 1e-25


def as_meant(value: float, *, decimal: bool) -> Value:
    """A double as an exact rational: as it is, or as the decimal it prints as."""
    return rational(repr(float(value))) if decimal else fmpq(*float(value).as_integer_ratio())


SLOW_TO_LOAD = "sympy"


def rungs(family: Family, *, slow: bool = True) -> list[Rung]:
    """Every rung that works for a family, cheapest number system first.

    Parameters
    ----------
    family : Family
    slow : bool
        Also SymPy, which takes longer to load than all the rest to run on a few inputs.
    """
    formula = family.formula
    if formula is None:
        found = [*RUNGS[family.name](family), _stable(family)]
        return [rung for rung in found if slow or rung.key != SLOW_TO_LOAD]
    found = [_array(family, formula, 32), _array(family, formula, 64), _stable(family)]
    if fits_pairs(formula):
        found.append(_pairs(family, formula))
    if family.rational:
        found.append(_exact(family, formula))
    if not family.whole_turn:
        found.append(_balls(family, formula))
    found.append(_multiprecision(family, formula))
    return [*found, _symbolic(family, formula)] if slow else found


def _array(family: Family, formula: Expr, bits: int) -> Rung:
    number = np.float32 if bits == 32 else np.float64
    if family.printed is not None:
        return Rung(f"float{bits}", "array", family.printed, lambda column: column.astype(number))
    compiled = compile_expr(formula, arrays(bits))

    def run(*columns: Column) -> Column:
        return compiled(dict(zip(family.names, columns, strict=True)))

    return Rung(f"float{bits}", "array", run, lambda column: column.astype(number))


def _stable(family: Family) -> Rung:
    def finish(result: Column) -> Column:
        return np.ma.filled(result, np.nan)

    return Rung("stable", "array", family.stable, lambda column: column, finish)


def _pairs(family: Family, formula: Expr) -> Rung:
    compiled = compile_expr(formula, pairs())

    def run(*columns: Array) -> Array:
        values = map(Pair, columns)
        total: Pair = compiled(dict(zip(family.names, values, strict=True)))
        return total.rounded()

    return Rung("double-double", "array", run, lambda column: column, lambda result: result)


def _environment(family: Family, convert: Callable[[float], Any]) -> Callable[..., Any]:
    return lambda row: {n: convert(v) for n, v in zip(family.names, row, strict=True)}


def _exact(family: Family, formula: Expr) -> Rung:
    compiled = compile_expr(formula, exact())
    prepare = _environment(family, lambda v: as_meant(v, decimal=family.decimal))
    return Rung("exact", "scalar", compiled, prepare, to_float)


def _balls(family: Family, formula: Expr) -> Rung:
    compiled = compile_expr(formula, exact())
    prepare = _environment(family, lambda v: as_meant(v, decimal=family.decimal))
    return Rung("arb", "scalar", lambda inputs: ball_value(compiled, inputs), prepare, to_float)


def _multiprecision(family: Family, formula: Expr) -> Rung:
    import mpmath as mp

    compiled = compile_expr(formula, multiprecision())

    def run(inputs: Inputs) -> Value:
        with mp.workdps(DIGITS):
            return compiled(inputs)

    return Rung("mpmath", "scalar", run, _precise(family))


def _precise(family: Family) -> Callable[..., Any]:
    import mpmath as mp

    def convert(value: float) -> Value:
        with mp.workdps(ORACLE_DIGITS):
            return mp.mpf(repr(float(value))) if family.decimal else mp.mpf(float(value))

    return _environment(family, convert)


def _symbolic(family: Family, formula: Expr) -> Rung:
    import sympy

    compiled = compile_expr(formula, symbolic())

    def convert(value: float) -> Value:
        q = as_meant(value, decimal=family.decimal)
        return sympy.Rational(int(q.p), int(q.q))

    def run(inputs: Inputs) -> Value:
        return compiled(inputs).evalf(DIGITS)

    return Rung("sympy", "scalar", run, _environment(family, convert))


class OraclesDisagree(QuizgenError):
    """The exact or certified value and mpmath's differ: one of them is wrong."""


def truths(family: Family, rows: list[tuple[float, ...]]) -> list[float]:
    """Correctly rounded values, each computed twice by independent libraries.

    Raises
    ------
    OraclesDisagree
        If the two differ in the first 25 digits.
    """
    import mpmath as mp

    first, second = oracles(family)
    result = []
    for row in rows:
        certain = first(row)
        with mp.workdps(ORACLE_DIGITS):
            other = second(row)
            value = _as_mpf(certain)
            if abs(value - other) > AGREEMENT * abs(value) + mp.mpf(10) ** (-ORACLE_DIGITS + 20):
                raise OraclesDisagree(f"{family.name}{row}: {value} and {other}")
        result.append(to_float(certain))
    return result


def oracles(family: Family) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The certified oracle and the independent one, as functions of a row of doubles."""
    formula = family.formula
    if formula is None:
        return ORACLES[family.name]
    compiled = compile_expr(formula, exact())
    precise = compile_expr(formula, multiprecision())
    prepare = _environment(family, lambda v: as_meant(v, decimal=family.decimal))
    convert = _precise(family)
    if family.rational:
        return (lambda row: compiled(prepare(row))), (lambda row: precise(convert(row)))
    return (
        lambda row: ball_value(compiled, prepare(row), ORACLE_BITS),
        lambda row: precise(convert(row)),
    )


def _as_mpf(value: Value) -> Value:
    import mpmath as mp

    if hasattr(value, "rad"):
        mantissa, power = value.mid().man_exp()
        return mp.mpf((int(mantissa), int(power)))
    return mp.mpf(int(value.p)) / int(value.q)
