"""The right value of a formula: exact fractions or Arb balls, for doubles taken as they are."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from flint import arb, fmpq

from quizgen.core.errors import MathError
from quizgen.maths.number_systems import compile_expr, exact_system
from quizgen.maths.numbers import to_float, to_rational
from quizgen.maths.precision import working_precision
from quizgen.numerics.rational import exact_fraction
from quizgen.tradeoff.formulas import Columns, Formula
from quizgen.tradeoff.lines import Column

_BITS = 63
"""Certain bits of a ball, so that rounding it to 53 is right."""
_MOST_BITS = 12800

Inputs = Mapping[str, Any]


def truths(formula: Formula, columns: Columns) -> Column:
    """Return the correctly rounded values of a formula.

    Parameters
    ----------
    formula : Formula
    columns : list of array
        Inputs; those of ``decimal`` formulas mean the decimals that they print as.

    Raises
    ------
    MathError
        If a ball does not become small enough, as where there is no answer.
    """
    compute = _choose_exact_function(formula)
    rows = zip(*(column.tolist() for column in columns), strict=True)
    names = formula.names.split()
    read = _to_printed_decimal if formula.decimal else exact_fraction
    return np.array(
        [
            _round_to_nearest_double(compute, dict(zip(names, map(read, row), strict=True)))
            for row in rows
        ]
    )


def _choose_exact_function(formula: Formula) -> Callable[[Inputs], Any]:
    """Return a function that computes the formula in balls (arb) or fractions."""
    special = {"inverse-distortion": _evaluate_inverse_radius, "poisson": _evaluate_poisson}
    return special.get(formula.name) or compile_expr(formula.tree, exact_system())


def _to_printed_decimal(value: float) -> fmpq:
    """Return the decimal that a float prints as."""
    return to_rational(repr(value))


def _round_to_nearest_double(compute: Callable[[Inputs], Any], given: Inputs) -> float:
    """Return the nearest double of what is computed, with as much precision as that takes."""
    precision = 80
    while precision <= _MOST_BITS:
        with working_precision(precision):
            try:
                value = compute(given)
            except MathError:  # a sign that so few bits cannot tell
                value = None
            if isinstance(value, fmpq):
                return to_float(value)
            if value is not None and value.rel_accuracy_bits() >= _BITS:
                return float(value.mid())
        precision *= 2
    raise MathError("a ball does not become small enough")


def _evaluate_inverse_radius(given: Inputs) -> arb:
    """Return the root of the cubic in closed form: 2/sqrt(-3 k) sin(asin(r/fold)/3)."""
    size = (-3 * arb(given["k"])).sqrt()
    return 2 / size * ((3 * size * given["r"] / 2).asin() / 3).sin()


def _evaluate_poisson(given: Inputs) -> arb:
    """Return the Poisson probability of a count."""
    k, lam = arb(given["k"]), arb(given["lam"])
    return (k * lam.log() - lam - (k + 1).lgamma()).exp()


MOST_DIGITS = 16
ALL_DIGITS = 17.0
"""Stands for a result that is right to the last bit."""


def correct_digits(value: float, truth: float, turn: float = 0.0) -> float:
    """Return the correct decimal digits of a result: 0 to 16, or 17 if it is the nearest double."""
    if math.isnan(value) or math.isinf(value) != math.isinf(truth):
        return 0.0
    if value == truth:
        return ALL_DIGITS
    if turn:
        off = abs((value - truth + turn / 2) % turn - turn / 2) / turn
        return _convert_error_to_digits(off) if off else ALL_DIGITS
    return _convert_error_to_digits(abs(value - truth) / abs(truth)) if truth else 0.0


def _convert_error_to_digits(relative: float) -> float:
    """Return -log10 of a relative error, between 0 and `MOST_DIGITS`."""
    return min(max(0.0, -math.log10(relative)), float(MOST_DIGITS))
