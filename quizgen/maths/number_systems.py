"""Number systems, and formulas compiled for them.

A formula is compiled once per number system into nested closures. Rationals become certified balls
where a value is irrational; floats serve figures; arrays serve the comparison of what accuracy
costs; SymPy compares forms.
"""

from __future__ import annotations

import builtins
import math
import operator
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from functools import cache, partial, reduce
from operator import itemgetter
from struct import pack, unpack
from typing import TypeAlias

import msgspec

from quizgen.core.errors import MathError
from quizgen.maths.operators import CONDITIONS, MANY, OPERATORS
from quizgen.maths.tree import Call, Expr, Num, Sym, operators_in
from quizgen.maths.values import AnyNumber

Environment: TypeAlias = Mapping[str, AnyNumber]
"""Quantities by name, all in one number system."""

CompiledFormula: TypeAlias = Callable[[Environment], AnyNumber]
"""A formula compiled for one number system."""

OperatorFunction: TypeAlias = Callable[..., AnyNumber]
"""What an operator does in one number system."""

# In every number system whose relations give Python's true and false.
_LOGIC: dict[str, OperatorFunction] = {
    "logical_and": lambda a, b: bool(a and b),
    "logical_or": lambda a, b: bool(a or b),
}


class NumberSystem(msgspec.Struct, frozen=True):
    """A number system: how to make a constant and what each operator does.

    Operators that take any number of arguments are functions of two: formulas fold them.
    """

    name: str
    constant: Callable[[Fraction], AnyNumber]
    ops: Mapping[str, OperatorFunction]
    truth: Callable[[AnyNumber], bool] = bool
    guard: Callable[[CompiledFormula], CompiledFormula] | None = None
    """What a compiled formula is wrapped in: certified balls need a stated precision."""


def compile_expr(expr: Expr, system: NumberSystem) -> CompiledFormula:
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
    compiled = compile_nested(expr, system)
    return compiled if system.guard is None else system.guard(compiled)


def compile_nested(expr: Expr, system: NumberSystem) -> CompiledFormula:
    """Compile a formula that runs among others, where the precision is stated once around all."""
    if isinstance(expr, Num):
        constant = system.constant(expr.value)
        return lambda _env: constant
    if isinstance(expr, Sym):
        return itemgetter(expr.name)
    return _compile_any_call(expr, system)


def _compile_any_call(expr: Call, system: NumberSystem) -> CompiledFormula:
    if expr.op == "piecewise":
        return _compile_piecewise(expr, system)
    if OPERATORS[expr.op].folds and len(expr.args) > MANY:
        return _compile_run(system.ops[expr.op], expr.args, system)
    if OPERATORS[expr.op].folds and len(expr.args) != 2:
        if len(expr.args) == 1 and f"list_{expr.op}" in system.ops:  # of one list, or one number
            return _compile_call(Call(f"list_{expr.op}", expr.args), system)
        return compile_nested(reduce(partial(_make_binary_call, expr.op), expr.args), system)
    return _compile_call(expr, system)


def _make_binary_call(op: str, first: Expr, second: Expr) -> Expr:
    return Call(op, (first, second))


_SINGLES: dict[type[Expr], Callable[[OperatorFunction, AnyNumber], CompiledFormula]] = {
    Sym: lambda op, a: lambda env: op(env[a]),
    Num: lambda op, a: lambda _env: op(a),
    Call: lambda op, a: lambda env: op(a(env)),
}
_PAIRS: dict[
    tuple[type[Expr], type[Expr]],
    Callable[[OperatorFunction, AnyNumber, AnyNumber], CompiledFormula],
] = {
    (Sym, Sym): lambda op, a, b: lambda env: op(env[a], env[b]),
    (Sym, Num): lambda op, a, b: lambda env: op(env[a], b),
    (Sym, Call): lambda op, a, b: lambda env: op(env[a], b(env)),
    (Num, Sym): lambda op, a, b: lambda env: op(a, env[b]),
    (Num, Num): lambda op, a, b: lambda _env: op(a, b),
    (Num, Call): lambda op, a, b: lambda env: op(a, b(env)),
    (Call, Sym): lambda op, a, b: lambda env: op(a(env), env[b]),
    (Call, Num): lambda op, a, b: lambda env: op(a(env), b),
    (Call, Call): lambda op, a, b: lambda env: op(a(env), b(env)),
}
"""Kinds of the operands to an operator of them: most are quantities or constants, read in place."""


def _compile_call(expr: Call, system: NumberSystem) -> CompiledFormula:
    op, kinds = system.ops[expr.op], tuple(map(type, expr.args))
    operands = [_compile_operand(arg, system) for arg in expr.args]
    if len(kinds) == 1:
        return _SINGLES[kinds[0]](op, *operands)
    if len(kinds) == 2:
        return _PAIRS[kinds](op, *operands)
    return _compile_many(op, expr.args, system)


def _compile_operand(expr: Expr, system: NumberSystem) -> AnyNumber:
    """What an operator is compiled with: a name, a constant or a compiled formula."""
    if isinstance(expr, Sym):
        return expr.name
    return system.constant(expr.value) if isinstance(expr, Num) else compile_nested(expr, system)


def _compile_many(
    op: OperatorFunction, args: Iterable[Expr], system: NumberSystem
) -> CompiledFormula:
    parts = [compile_nested(arg, system) for arg in args]
    return lambda env: op(*[part(env) for part in parts])


def _compile_run(
    op: OperatorFunction, args: Iterable[Expr], system: NumberSystem
) -> CompiledFormula:
    """A run of one sign as long as a line may be, in a loop: nested it would be too deep."""
    parts = [compile_nested(arg, system) for arg in args]
    return lambda env: reduce(op, (part(env) for part in parts))


def _compile_piecewise(expr: Call, system: NumberSystem) -> CompiledFormula:
    if "piecewise" in system.ops:
        return _compile_many(system.ops["piecewise"], expr.args, system)
    parts = [compile_nested(arg, system) for arg in expr.args]
    pairs = list(zip(parts[:-1:2], parts[1::2], strict=True))
    otherwise = parts[-1]

    def choose(env: Environment) -> AnyNumber:
        for value, condition in pairs:
            if system.truth(condition(env)):
                return value(env)
        return otherwise(env)

    return choose


def select_branch(expr: Expr, env: Environment, system: NumberSystem) -> Expr:
    """Replace each ``piecewise`` by the branch that applies, for showing one worked line."""
    if not isinstance(expr, Call) or "piecewise" not in operators_in(expr):
        return expr
    if expr.op != "piecewise":
        return Call(expr.op, tuple(select_branch(arg, env, system) for arg in expr.args))
    for value, condition in zip(expr.args[:-1:2], expr.args[1::2], strict=True):
        if system.truth(compile_expr(condition, system)(env)):
            return select_branch(value, env, system)
    return select_branch(expr.args[-1], env, system)


def operator_functions(
    system: str, *sources: object, **own: OperatorFunction
) -> dict[str, OperatorFunction]:
    """What each operator of the table does in a number system.

    Parameters
    ----------
    system : str
        Its name in the table.
    *sources : module
        Where functions are looked up, in order.
    **own : callable
        Functions that none of them has, under the name that the table gives.
    """
    found = {}
    for row in OPERATORS.values():
        if system not in row.absent:
            name = row.function_in(system)
            found[row.name] = own[name] if name in own else _looked_up(name, sources)
    return found


def _looked_up(name: str, sources: tuple[object, ...]) -> OperatorFunction:
    op: OperatorFunction = next(
        getattr(source, name) for source in sources if hasattr(source, name)
    )
    return op


@cache
def exact_system() -> NumberSystem:
    """Exact rationals (``flint.fmpq``), and certified balls (``flint.arb``) beyond them."""
    from flint import fmpq

    from quizgen.maths import exact as own
    from quizgen.maths.list_operators import build_list_functions
    from quizgen.maths.numbers import to_rational
    from quizgen.maths.precision import at_working_precision

    lists = build_list_functions(own.square_root, fmpq)
    ops = operator_functions("exact", own, operator, own.BALLS, **_LOGIC, **lists)
    return NumberSystem("exact", to_rational, ops, guard=at_working_precision)


@cache
def float64_system() -> NumberSystem:
    """Python floats: the fast approximation used by figures."""
    from quizgen.maths.list_operators import build_list_functions

    own: dict[str, OperatorFunction] = {
        **build_list_functions(math.sqrt, float),
        "sign": lambda a: 0.0 if a == 0 else math.copysign(1.0, a),
        "floor": lambda a: float(math.floor(a)),
        "ceil": lambda a: float(math.ceil(a)),
        # Half away from zero, as the stems promise; Python's round takes halves to even.
        "round_float_half_away": lambda a: math.copysign(math.floor(abs(a) + 0.5), a),
        "pi": lambda: math.pi,
    }
    functions = operator_functions("floats", math, operator, builtins, **_LOGIC, **own)
    return NumberSystem("float64", float, functions)


def round_to_float32(x: float) -> float:
    """Round to float32."""
    return float(unpack("f", pack("f", x))[0])


@cache
def float32_system() -> NumberSystem:
    """Numbers rounded to float32 after every operation; truth values stay."""

    def rounding(name: str, op: OperatorFunction) -> OperatorFunction:
        return op if name in CONDITIONS | {"sort"} else lambda *args: round_to_float32(op(*args))

    ops = {name: rounding(name, op) for name, op in float64_system().ops.items()}
    return NumberSystem("float32", lambda q: round_to_float32(float(q)), ops)


@cache
def array_system(bits: int) -> NumberSystem:
    """NumPy arrays of 32 or 64 bits, the formula as it is printed."""
    import numpy as np

    number = np.float32 if bits == 32 else np.float64
    own: dict[str, OperatorFunction] = {
        "erf": _find_special_function("erf", bits),
        "erfc": _find_special_function("erfc", bits),
        "round_float_half_away": lambda a: np.copysign(np.floor(np.abs(a) + number(0.5)), a),
        "pi": lambda: number(math.pi),
        "piecewise": _select_array_branch,
    }
    return NumberSystem(
        f"float{bits} arrays",
        lambda q: number(float(q)),
        operator_functions("arrays", operator, np, **own),
    )


def _find_special_function(name: str, bits: int) -> OperatorFunction:
    """SciPy's function if SciPy is there, else the C library's, element by element."""
    import numpy as np

    try:
        import scipy.special
    except ImportError:
        slow = np.vectorize(getattr(math, name), otypes=[np.float64])
        return lambda x: slow(x).astype(np.float32 if bits == 32 else np.float64)
    function: OperatorFunction = getattr(scipy.special, name)
    return function


def _select_array_branch(*args: AnyNumber) -> AnyNumber:
    import numpy as np

    value = args[-1]
    for chosen, condition in zip(args[-3::-2], args[-2::-2], strict=True):
        value = np.where(condition, chosen, value)
    return value


@cache
def sympy_system() -> NumberSystem:
    """SymPy expressions on exact rationals."""
    import sympy

    own: dict[str, OperatorFunction] = {
        "log2": lambda x: sympy.log(x) / sympy.log(2),
        "log10": lambda x: sympy.log(x) / sympy.log(10),
        "round_float_half_away": lambda x: (
            sympy.sign(x) * sympy.floor(abs(x) + sympy.Rational(1, 2))
        ),
        "pi": lambda: sympy.pi,
    }
    ops = operator_functions("sympy", operator, sympy, **own)
    return NumberSystem("SymPy", lambda q: sympy.Rational(q.numerator, q.denominator), ops)


def evaluate(expr: Expr, env: Environment, system: NumberSystem | None = None) -> AnyNumber:
    """Evaluate a tree once (compile it instead when it is needed often).

    Raises
    ------
    MathError
        If there is no finite real value.
    """
    try:
        return compile_expr(expr, system or exact_system())(env)
    except (ZeroDivisionError, OverflowError) as error:
        raise MathError(str(error)) from error
