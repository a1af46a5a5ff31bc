"""Formula trees and the number systems they are evaluated in.

One small tree stands between the three sources of formulas (a solver's SymPy chain, mathematics
typed by an author, mathematics typed by a student) and their uses (exact value, certified ball,
float, array, printing). A tree is compiled once per number system into nested closures; nothing
here calls SymPy or runs text as code.

``Num(Fraction)``, ``Sym(name)`` and ``Call(op, args)`` are the only nodes. Operators:

* arithmetic: ``add mul`` (two or more arguments), ``sub div neg pow``
* functions: ``sqrt exp ln log2 log10 sin cos tan asin acos atan atan2 erf erfc abs sign
  floor ceil round mod min max``
* constants: ``pi``
* choice: ``piecewise`` with arguments value, condition, value, condition, ..., value
* relations: ``eq ne lt le gt ge``, and ``and or not``
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

from quizgen.errors import MathError, Undecided


@dataclass(frozen=True, slots=True)
class Num:
    """A rational constant; ``decimal`` asks printers for 2.2 instead of 11/5."""

    value: Fraction
    decimal: bool = False


@dataclass(frozen=True, slots=True)
class Sym:
    """A named quantity."""

    name: str


@dataclass(frozen=True, slots=True)
class Call:
    """An operator or function applied to arguments."""

    op: str
    args: tuple[Expr, ...]


Expr = Num | Sym | Call
Env = Mapping[str, Any]
Compiled = Callable[[Env], Any]

RELATIONS = frozenset({"eq", "ne", "lt", "le", "gt", "ge", "and", "or", "not"})


@dataclass(frozen=True, slots=True)
class Field:
    """A number system: how to make a constant and what each operator does."""

    name: str
    constant: Callable[[Fraction], Any]
    ops: Mapping[str, Callable[..., Any]]
    truth: Callable[[Any], bool] = bool
    guard: Callable[[Compiled], Compiled] | None = None
    """What a compiled formula is wrapped in: certified balls need a stated precision."""


def number(value: int | str | Fraction) -> Num:
    """Make a constant node from an integer, a fraction or a decimal text."""
    decimal = isinstance(value, str) and "." in value
    return Num(Fraction(value), decimal)


def walk(expr: Expr) -> Iterator[Expr]:
    """Yield every node of a tree, parents first."""
    yield expr
    if isinstance(expr, Call):
        for arg in expr.args:
            yield from walk(arg)


def names(expr: Expr) -> frozenset[str]:
    """Names of the quantities that occur in a tree."""
    return frozenset(node.name for node in walk(expr) if isinstance(node, Sym))


def substitute(expr: Expr, values: Mapping[str, Expr]) -> Expr:
    """Replace named quantities by other trees."""
    if isinstance(expr, Sym):
        return values.get(expr.name, expr)
    if isinstance(expr, Call):
        return Call(expr.op, tuple(substitute(arg, values) for arg in expr.args))
    return expr


def compile_expr(expr: Expr, field: Field) -> Compiled:
    """Compile a tree into a function of an environment, for one number system.

    Parameters
    ----------
    expr : Expr
        The tree.
    field : Field
        The number system, for example ``exact()``.

    Returns
    -------
    callable
        Takes a mapping from names to numbers of the field and returns the value.
    """
    compiled = compile_inner(expr, field)
    return compiled if field.guard is None else field.guard(compiled)


def compile_inner(expr: Expr, field: Field) -> Compiled:
    """Compile a formula that runs among others, where the precision is stated once around all."""
    if isinstance(expr, Num):
        constant = field.constant(expr.value)
        return lambda _env: constant
    if isinstance(expr, Sym):
        return _lookup(expr.name)
    if expr.op == "piecewise":
        return _compile_piecewise(expr, field)
    return _compile_call(field.ops[expr.op], [compile_inner(arg, field) for arg in expr.args])


def _lookup(name: str) -> Compiled:
    return lambda env: env[name]


def _compile_call(op: Callable[..., Any], args: list[Compiled]) -> Compiled:
    if len(args) == 1:
        (first,) = args
        return lambda env: op(first(env))
    if len(args) == 2:
        first, second = args
        return lambda env: op(first(env), second(env))
    return lambda env: op(*[arg(env) for arg in args])


def _compile_piecewise(expr: Call, field: Field) -> Compiled:
    if "piecewise" in field.ops:
        return _compile_call(
            field.ops["piecewise"], [compile_inner(arg, field) for arg in expr.args]
        )
    parts = [compile_inner(arg, field) for arg in expr.args]
    pairs = list(zip(parts[:-1:2], parts[1::2], strict=True))
    otherwise = parts[-1]

    def choose(env: Env) -> Any:
        for value, condition in pairs:
            if field.truth(condition(env)):
                return value(env)
        return otherwise(env)

    return choose


def taken_branch(expr: Expr, env: Env, field: Field) -> Expr:
    """Replace each ``piecewise`` by the branch that applies, for showing one worked line."""
    if not isinstance(expr, Call):
        return expr
    if expr.op != "piecewise":
        return Call(expr.op, tuple(taken_branch(arg, env, field) for arg in expr.args))
    for value, condition in zip(expr.args[:-1:2], expr.args[1::2], strict=True):
        if field.truth(compile_expr(condition, field)(env)):
            return taken_branch(value, env, field)
    return taken_branch(expr.args[-1], env, field)


# Exact and certified: rationals while the value is rational, else real balls.


@cache
def exact() -> Field:
    """Exact rationals (``flint.fmpq``), and certified balls (``flint.arb``) beyond them."""
    from quizgen.maths import exact as operators
    from quizgen.maths.numbers import rational
    from quizgen.maths.precision import with_precision

    return Field("exact", rational, operators.OPS, guard=with_precision)


@cache
def floats() -> Field:
    """Python floats: the fast approximation used by figures."""
    from quizgen.maths import floats as operators

    return Field("float64", float, operators.OPS)


@cache
def singles() -> Field:
    """Numbers rounded to float32 after every operation."""
    from quizgen.maths import floats as operators

    return Field("float32", lambda q: operators.single(float(q)), operators.SINGLE_OPS)


def evaluate(expr: Expr, env: Env, field: Field | None = None) -> Any:
    """Evaluate a tree once (compile it instead when it is needed often).

    Raises
    ------
    MathError
        If there is no finite real value.
    """
    try:
        return compile_expr(expr, field or exact())(env)
    except (ZeroDivisionError, OverflowError) as error:
        raise MathError(str(error)) from error


__all__ = [
    "RELATIONS",
    "Call",
    "Compiled",
    "Env",
    "Expr",
    "Field",
    "Num",
    "Sym",
    "Undecided",
    "compile_expr",
    "compile_inner",
    "evaluate",
    "exact",
    "floats",
    "names",
    "number",
    "substitute",
    "taken_branch",
    "walk",
]
