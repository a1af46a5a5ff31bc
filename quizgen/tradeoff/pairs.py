"""Pairs of doubles as a number system: twice the working precision, on arrays."""

from __future__ import annotations

import operator
from fractions import Fraction
from functools import cache, reduce

from quizgen.arrays.double_double import Pair
from quizgen.maths.systems import NumberSystem, functions
from quizgen.maths.tree import Call, Expr, Num, walk


@cache
def pairs() -> NumberSystem:
    """Unevaluated sums of two doubles."""
    ops = functions("pairs", operator, pow=_power)
    return NumberSystem("double-double", _constant, ops)


def _constant(q: Fraction) -> Pair:
    high = float(q)
    return Pair(high, float(q - Fraction(high)))


def _power(x: Pair, n: Pair) -> Pair:
    return reduce(operator.mul, [x] * int(n.high))


def fits_pairs(expr: Expr) -> bool:
    """Whether every operator of a formula works on pairs."""
    calls = [node for node in walk(expr) if isinstance(node, Call)]
    return all(call.op in pairs().ops for call in calls) and all(
        isinstance(call.args[1], Num) and call.args[1].value in {2, 3, 4}
        for call in calls
        if call.op == "pow"
    )
