"""Proof of equality for rational formulas: both sides as quotients of exact polynomials."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache, reduce
from math import comb
from typing import Any

from flint import Ordering, fmpq, fmpq_mpoly_ctx

from quizgen.maths.numbers import to_rational
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in, walk_tree

LARGEST_POWER = 12
MOST_NODES = 60
HIGHEST_DEGREE = 64
"""Degree that a formula may have once it is multiplied out, powers of powers included."""
MOST_TERMS = 100_000
"""Products of terms that one multiplication may take: a formula of a line has a few hundred."""

Quotient = tuple[Any, Any]


def is_rational(tree: Expr) -> bool:
    """Return whether a formula uses arithmetic only, and is small enough to expand."""
    nodes = list(walk_tree(tree))
    return (
        len(nodes) <= MOST_NODES
        and all(not isinstance(node, Call) or node.op in _OPERATORS for node in nodes)
        and _bound_degree(tree) <= HIGHEST_DEGREE
    )


def _bound_degree(tree: Expr) -> int:
    """Return a degree that a formula does not exceed; a number counts, since powers lengthen it."""
    if not isinstance(tree, Call):
        return 1
    if tree.op == "pow":
        power = tree.args[1]
        times = abs(int(power.value)) if isinstance(power, Num) else LARGEST_POWER
        return _bound_degree(tree.args[0]) * min(times, HIGHEST_DEGREE + 1)
    return sum(map(_bound_degree, tree.args))


def prove_equal(first: Expr, second: Expr) -> bool:
    """Return whether two formulas are proved to be the same rational function.

    False proves nothing: they may differ, be no rational functions, or be too large to expand.
    """
    if not (is_rational(first) and is_rational(second)):
        return False
    used = tuple(sorted(names_in(first) | names_in(second)))
    try:
        top1, low1 = _of_key(first, used)
        top2, low2 = convert_to_quotient(second, used)
    except (ValueError, ZeroDivisionError):
        return False
    if max(len(top1) * len(low2), len(top2) * len(low1)) > MOST_TERMS:
        return False
    return bool(top1 * low2 == top2 * low1)


def convert_to_quotient(tree: Expr, used: tuple[str, ...]) -> Quotient:
    """Return a rational formula as a quotient of polynomials in the names used.

    Raises
    ------
    ValueError
        If an exponent is no integer up to ``LARGEST_POWER``.
    ZeroDivisionError
        If a divisor is zero everywhere.
    """
    ctx, env = _build_polynomial_field(used)
    return _evaluate_quotient(tree, ctx, env)


_of_key = lru_cache(maxsize=512)(convert_to_quotient)
"""The same for a key, which a whole class is compared with."""


@lru_cache(maxsize=512)
def _build_polynomial_field(used: tuple[str, ...]) -> tuple[fmpq_mpoly_ctx, dict[str, Quotient]]:
    """Return the context of polynomials in so many variables, and what each name stands for."""
    ctx = fmpq_mpoly_ctx.get([f"x{i}" for i in range(len(used))] or ["x0"], Ordering.lex)
    one = ctx.constant(1)
    return ctx, {name: (gen, one) for name, gen in zip(used, ctx.gens(), strict=False)}


def _evaluate_quotient(tree: Expr, ctx: fmpq_mpoly_ctx, env: Mapping[str, Quotient]) -> Quotient:
    """Return the quotient of a tree whose names stand for quotients; errors as its operators'."""
    if isinstance(tree, Num):
        return ctx.constant(to_rational(tree.value)), ctx.constant(1)
    if isinstance(tree, Sym):
        return env[tree.name]
    args = [_evaluate_quotient(arg, ctx, env) for arg in tree.args]
    op = _OPERATORS[tree.op]
    return op(*args) if len(args) <= 2 else reduce(op, args)


def _add_quotients(a: Quotient, b: Quotient) -> Quotient:
    """Return the sum over the product of the denominators; nothing is cancelled."""
    return _multiply(a[0], b[1]) + _multiply(b[0], a[1]), _multiply(a[1], b[1])


def _negate_quotient(a: Quotient) -> Quotient:
    """Return the quotient with the other sign."""
    return -a[0], a[1]


def _subtract_quotients(a: Quotient, b: Quotient) -> Quotient:
    """Return the difference over the product of the denominators."""
    return _add_quotients(a, _negate_quotient(b))


def _multiply_quotients(a: Quotient, b: Quotient) -> Quotient:
    """Return the product of the numerators over that of the denominators."""
    return _multiply(a[0], b[0]), _multiply(a[1], b[1])


def _multiply(a: Any, b: Any) -> Any:
    """Return the product of two polynomials.

    Raises
    ------
    ValueError
        If they have too many terms.
    """
    if len(a) * len(b) > MOST_TERMS:
        raise ValueError("too many terms")
    return a * b


def _divide_quotients(a: Quotient, b: Quotient) -> Quotient:
    """Return the first quotient times the second upside down.

    Raises
    ------
    ZeroDivisionError
        If the second is zero everywhere.
    """
    if b[0] == 0:
        raise ZeroDivisionError
    return _multiply(a[0], b[1]), _multiply(a[1], b[0])


def _raise_quotient(a: Quotient, b: Quotient) -> Quotient:
    """Return a power of a quotient, upside down for a negative exponent.

    Raises
    ------
    ValueError
        If the exponent is no integer up to ``LARGEST_POWER``, or there are too many terms.
    ZeroDivisionError
        If zero is raised to a negative power.
    """
    exponent = _require_integer_exponent(b)
    if exponent < 0:
        return _divide_quotients(
            (a[1] ** 0, a[1] ** 0), _raise_quotient(a, (b[1] * -exponent, b[1]))
        )
    if any(comb(len(side) + exponent, exponent) > MOST_TERMS for side in a if len(side) > 1):
        raise ValueError("too many terms")
    return a[0] ** exponent, a[1] ** exponent


def _require_integer_exponent(value: Quotient) -> int:
    """Return the integer that an exponent is.

    Raises
    ------
    ValueError
        If it holds a name, is no integer, or is beyond ``LARGEST_POWER`` either way.
    """
    top, low = value
    if not (top.is_constant() and low.is_constant()):
        raise ValueError("exponent is not a number")
    number = top.leading_coefficient() / low.leading_coefficient() if top != 0 else fmpq(0)
    if number.q != 1 or abs(number) > LARGEST_POWER:
        raise ValueError("exponent too large")
    return int(number.p)


_OPERATORS: dict[str, Callable[..., Quotient]] = {
    "add": _add_quotients,
    "sub": _subtract_quotients,
    "mul": _multiply_quotients,
    "div": _divide_quotients,
    "neg": _negate_quotient,
    "pow": _raise_quotient,
}
