"""Whether two forms say the same, in floats: it only ever rejects a draw."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeGuard

from quizgen.maths.number_systems import compile_expr, float64_system
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.tree import Call, Expr, names_in

APART = 2.0
"""Two values count as different when more than this many tolerances lie between them."""
NEAR = 1e-9
"""Relative distance at which two values count as one."""
TINY = 1e-12
"""Values below it count as this large."""
_STRUCTURES = frozenset({"matrix", "row", "vector", "set", "union", "interval", "complex", "eq"})
_POINTS = (0.731, 1.377, 2.219, 3.071, 0.263, -0.617, -1.849)
"""Where formulas are compared; each name takes its own turn of them."""


def forms_agree(
    first: Expr, second: Expr, relation: str = "", rule: Tolerance | None = None
) -> bool:
    """Whether two forms with numbers in place are the same one.

    Parameters
    ----------
    first, second : Expr
    relation : str
        ``constant`` or ``factor`` where they may differ by one, ``scale`` of vectors.
    rule : Tolerance, optional
        How near numbers count as the same, if not all figures are asked.
    """
    if first == second:
        return True
    if _is_call(first, "eq") and _is_call(second, "eq"):
        return _formulas_agree(_take_difference(first), _take_difference(second), "factor")
    if _is_inequality(first) and _is_inequality(second):
        sides = (_take_upper_side(first), _take_upper_side(second))
        return _STRICT[first.op] == _STRICT[second.op] and _formulas_agree(*sides, "positive")
    if _is_call(first, "vector") and _is_call(second, "vector") and relation == "scale":
        return _are_parallel(first, second)
    if isinstance(first, Call) and first.op in _STRUCTURES:
        return (
            isinstance(second, Call)
            and second.op == first.op
            and len(first.args) == len(second.args)
            and all(
                forms_agree(a, b, rule=rule) for a, b in zip(first.args, second.args, strict=True)
            )
        )
    return _formulas_agree(first, second, relation, rule)


def _is_call(expr: Expr, op: str) -> bool:
    """Return whether a formula is a call of an operator."""
    return isinstance(expr, Call) and expr.op == op


def _take_difference(equation: Expr) -> Expr:
    """Return left side minus right side of an equation, and any other formula as it is."""
    return Call("sub", equation.args) if isinstance(equation, Call) else equation


_STRICT = {"lt": "<", "gt": "<", "le": "<=", "ge": "<="}


def _is_inequality(expr: Expr) -> TypeGuard[Call]:
    """Return whether a formula is an inequality."""
    return isinstance(expr, Call) and expr.op in _STRICT


def _take_upper_side(inequality: Call) -> Expr:
    """Return what is positive where an inequality holds."""
    left, right = inequality.args
    return Call("sub", (right, left) if inequality.op[0] == "l" else (left, right))


def _are_parallel(first: Expr, second: Expr) -> bool:
    """Return whether two vectors are multiples of each other, by their 2x2 minors."""
    a, b = (_evaluate_components(arg) for arg in (first, second))
    return len(a) == len(b) and all(
        math.isclose(a[i] * b[j], a[j] * b[i], rel_tol=NEAR, abs_tol=1e-12)
        for i in range(len(a))
        for j in range(i)
    )


def _evaluate_components(vector: Expr) -> list[float]:
    """Return a vector's components as floats; NaN, which equals nothing, where one has none."""
    found = [_evaluate_at(arg, {}) for arg in (vector.args if isinstance(vector, Call) else ())]
    return [math.nan if value is None else value for value in found]


def _numbers_agree(first: Expr, second: Expr, rule: Tolerance) -> bool:
    """Return whether two numbers are nearer to each other than answers to both may be."""
    a, b = (_evaluate_at(number, {}) for number in (first, second))
    return a is not None and b is not None and abs(a - b) <= APART * rule.outer_width(a)


def _formulas_agree(
    first: Expr, second: Expr, relation: str, rule: Tolerance | None = None
) -> bool:
    """Return whether two formulas are related at every point where both have a value.

    ``relation`` is ``"constant"`` or ``"factor"`` if they may differ by one, anything else if they
    must be equal: numbers by the rule, if there is one. False if there is no such point.
    """
    names = sorted(names_in(first) | names_in(second))
    if rule is not None and not names:
        return _numbers_agree(first, second, rule)
    pairs = []
    for turn in range(len(_POINTS) if names else 1):
        env = {n: _POINTS[(turn + 2 * i) % len(_POINTS)] for i, n in enumerate(names)}
        a, b = _evaluate_at(first, env), _evaluate_at(second, env)
        if a is not None and b is not None:
            pairs.append((a, b))
    return bool(pairs) and _are_related(pairs, relation)


def _are_related(pairs: Sequence[tuple[float, float]], relation: str) -> bool:
    """Return whether pairs of values differ by one constant, by one factor, or not at all."""
    if relation == "constant":
        shift = pairs[0][0] - pairs[0][1]
        return all(abs(a - b - shift) <= NEAR * max(abs(a), abs(b), TINY) for a, b in pairs)
    if relation in {"factor", "positive"}:
        a0, b0 = pairs[0]
        same_sign = relation == "factor" or a0 * b0 > 0
        return same_sign and all(_is_near(a * b0, a0 * b) for a, b in pairs)
    return all(_is_near(a, b) for a, b in pairs)


def _is_near(a: float, b: float) -> bool:
    """Return whether two floats agree."""
    return math.isclose(a, b, rel_tol=NEAR, abs_tol=NEAR * TINY)


def _evaluate_at(expr: Expr, env: dict[str, float]) -> float | None:
    """Return a formula's value at a point as a float; None if it has no finite one there."""
    if _is_call(expr, "infinity"):
        return math.inf
    try:
        value = float(compile_expr(expr, float64_system())(env))
    except (ValueError, ZeroDivisionError, OverflowError, TypeError, KeyError):
        return None
    return value if math.isfinite(value) else None
