"""Number systems, and formulas compiled for them.

A formula is compiled once per number system into nested closures. Rationals become certified balls
where a value is irrational; floats serve figures; arrays, pairs of doubles, mpmath and SymPy serve
the comparison of what accuracy costs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import TypeAlias

from quizgen.errors import MathError
from quizgen.maths.tree import Call, Expr, Num, Sym
from quizgen.maths.values import AnyNumber

Env: TypeAlias = Mapping[str, AnyNumber]
"""Quantities by name, all in one number system."""

Compiled: TypeAlias = Callable[[Env], AnyNumber]
"""A formula compiled for one number system."""

Op: TypeAlias = Callable[..., AnyNumber]
"""What an operator does in one number system."""


@dataclass(frozen=True, slots=True)
class NumberSystem:
    """A number system: how to make a constant and what each operator does."""

    name: str
    constant: Callable[[Fraction], AnyNumber]
    ops: Mapping[str, Op]
    truth: Callable[[AnyNumber], bool] = bool
    guard: Callable[[Compiled], Compiled] | None = None
    """What a compiled formula is wrapped in: certified balls need a stated precision."""


def compile_expr(expr: Expr, system: NumberSystem) -> Compiled:
    """Compile a tree into a function of an environment, for one number system.

    Parameters
    ----------
    expr : Expr
        The tree.
    system : NumberSystem
        The number system, for example ``exact()``.

    Returns
    -------
    callable
        Takes a mapping from names to numbers of the system and returns the value.
    """
    compiled = compile_inner(expr, system)
    return compiled if system.guard is None else system.guard(compiled)


def compile_inner(expr: Expr, system: NumberSystem) -> Compiled:
    """Compile a formula that runs among others, where the precision is stated once around all."""
    if isinstance(expr, Num):
        constant = system.constant(expr.value)
        return lambda _env: constant
    if isinstance(expr, Sym):
        return _lookup(expr.name)
    if expr.op == "piecewise":
        return _compile_piecewise(expr, system)
    return _compile_call(system.ops[expr.op], [compile_inner(arg, system) for arg in expr.args])


def _lookup(name: str) -> Compiled:
    return lambda env: env[name]


def _compile_call(op: Op, args: list[Compiled]) -> Compiled:
    if len(args) == 1:
        (first,) = args
        return lambda env: op(first(env))
    if len(args) == 2:
        first, second = args
        return lambda env: op(first(env), second(env))
    return lambda env: op(*[arg(env) for arg in args])


def _compile_piecewise(expr: Call, system: NumberSystem) -> Compiled:
    if "piecewise" in system.ops:
        return _compile_call(
            system.ops["piecewise"], [compile_inner(arg, system) for arg in expr.args]
        )
    parts = [compile_inner(arg, system) for arg in expr.args]
    pairs = list(zip(parts[:-1:2], parts[1::2], strict=True))
    otherwise = parts[-1]

    def choose(env: Env) -> AnyNumber:
        for value, condition in pairs:
            if system.truth(condition(env)):
                return value(env)
        return otherwise(env)

    return choose


def taken_branch(expr: Expr, env: Env, system: NumberSystem) -> Expr:
    """Replace each ``piecewise`` by the branch that applies, for showing one worked line."""
    if not isinstance(expr, Call):
        return expr
    if expr.op != "piecewise":
        return Call(expr.op, tuple(taken_branch(arg, env, system) for arg in expr.args))
    for value, condition in zip(expr.args[:-1:2], expr.args[1::2], strict=True):
        if system.truth(compile_expr(condition, system)(env)):
            return taken_branch(value, env, system)
    return taken_branch(expr.args[-1], env, system)


@cache
def exact() -> NumberSystem:
    """Exact rationals (``flint.fmpq``), and certified balls (``flint.arb``) beyond them."""
    from quizgen.maths import exact as operators
    from quizgen.maths.numbers import rational
    from quizgen.maths.precision import with_precision

    return NumberSystem("exact", rational, operators.OPS, guard=with_precision)


@cache
def floats() -> NumberSystem:
    """Python floats: the fast approximation used by figures."""
    from quizgen.maths import floats as operators

    return NumberSystem("float64", float, operators.OPS)


@cache
def singles() -> NumberSystem:
    """Numbers rounded to float32 after every operation."""
    from quizgen.maths import floats as operators

    return NumberSystem("float32", lambda q: operators.single(float(q)), operators.SINGLE_OPS)


def evaluate(expr: Expr, env: Env, system: NumberSystem | None = None) -> AnyNumber:
    """Evaluate a tree once (compile it instead when it is needed often).

    Raises
    ------
    MathError
        If there is no finite real value.
    """
    try:
        return compile_expr(expr, system or exact())(env)
    except (ZeroDivisionError, OverflowError) as error:
        raise MathError(str(error)) from error
