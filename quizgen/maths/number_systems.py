"""Number systems, and formulas compiled for them.

A formula is compiled once per number system into nested closures. Rationals become certified balls
where a value is irrational; floats serve figures; arrays serve the comparison of what accuracy
costs; SymPy compares forms.
"""

from __future__ import annotations

import builtins
import math
import operator
from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cache, partial, reduce
from operator import itemgetter
from struct import pack, unpack
from typing import TypeAlias

import msgspec

from quizgen.core.errors import MathError
from quizgen.maths.operators import (
    BINDERS,
    CONDITIONS,
    MANY,
    OPERATORS,
    UNEVALUATED,
    OperatorSyntax,
)
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
    """Return a tree compiled into a function of an environment, for one number system.

    Parameters
    ----------
    expr : Expr
        The tree.
    system : NumberSystem
        The number system, for example ``exact_system()``.

    Returns
    -------
    callable
        Takes a mapping from names to numbers of the system and returns the value.
    """
    compiled = compile_nested(expr, system)
    return compiled if system.guard is None else system.guard(compiled)


def compile_nested(expr: Expr, system: NumberSystem) -> CompiledFormula:
    """Return a formula compiled to run among others: who runs it sets the precision."""
    if isinstance(expr, Num):
        constant = system.constant(expr.value)
        return lambda _env: constant
    if isinstance(expr, Sym):
        return itemgetter(expr.name)
    own = _find_compiler(expr, system)
    if own is not None:
        return own(expr, system)
    if OPERATORS[expr.op].folds and len(expr.args) > MANY:
        return _compile_run(system.ops[expr.op], expr.args, system)
    if OPERATORS[expr.op].folds and len(expr.args) != 2:
        return compile_nested(reduce(partial(_make_binary_call, expr.op), expr.args), system)
    return _compile_call(expr, system)


LARGEST_SUM = 10_000
"""Most terms of a sum, factors of a product."""


def _compile_binder(expr: Call, system: NumberSystem) -> CompiledFormula:
    """Return a sum or product over the whole numbers between two bounds, or an integral."""
    name = expr.args[0].name if isinstance(expr.args[0], Sym) else ""
    low, high, body = (compile_nested(arg, system) for arg in expr.args[1:])
    if expr.op == "integral":
        return _compile_integral(expr, name, system)
    combine, start = system.ops["add" if expr.op == "sum" else "mul"], Fraction(expr.op != "sum")

    def run(env: Environment) -> AnyNumber:
        """Return the sum or product; ``MathError`` if it has ``LARGEST_SUM`` terms or more."""
        first, last = _read_bound(low(env)), _read_bound(high(env))
        if last - first >= LARGEST_SUM:
            raise MathError(f"more than {LARGEST_SUM} terms")
        total = system.constant(start)
        for index in range(first, last + 1):
            total = combine(total, body({**env, name: system.constant(Fraction(index))}))
        return total

    return run


def _read_bound(value: AnyNumber) -> int:
    """Return the bound of a sum as an integer; ``MathError`` if it is no whole number."""
    if value != int(value):
        raise MathError("a sum runs over whole numbers")
    return int(value)


def _compile_integral(expr: Call, name: str, system: NumberSystem) -> CompiledFormula:
    """Return an integral by mpmath at two precisions that agree, as a ball around both."""
    from quizgen.maths.quadrature import integrate

    bounds = [compile_nested(arg, system) for arg in expr.args[1:3]]
    body = compile_nested(expr.args[3], system)

    def run(env: Environment) -> AnyNumber:
        """Return the integral, computed numerically."""
        low, high = (bound(env) for bound in bounds)
        return integrate(lambda x: body({**env, name: x}), low, high, system)

    return run


_EXACT = frozenset({"exact", "bounded"})
_PERIODIC = frozenset({"sin", "cos", "tan"})


def _compile_special_angle(expr: Call, system: NumberSystem) -> CompiledFormula:
    """Return a function of an angle that may be a rational multiple of pi, exact if it can be.

    By Niven's theorem these are the multiples of 30° for sine and cosine, of 45° for the tangent.
    """
    angle = compile_nested(expr.args[0], _pi_multiples())
    usual = _compile_call(expr, system)

    def run(env: Environment) -> AnyNumber:
        """Return the exact value where there is one, else that of the usual operator."""
        try:
            whole, times = angle(_AsPairs(env))
        except (TypeError, KeyError, ZeroDivisionError):
            return usual(env)
        found = _rational_value(expr.op, times) if whole == 0 else None
        return usual(env) if found is None else found

    return run


_COSINES = {0: 2, 1: None, 2: 1, 3: 0, 4: -1, 5: None, 6: -2}
"""Multiple of 30° to twice its cosine, where that is rational."""


def _rational_value(op: str, times: AnyNumber) -> AnyNumber:
    """Return sine, cosine or tangent at so many times pi, if it is rational; else None."""
    from flint import fmpq

    if op == "tan":
        quarter = times * 4
        if quarter.q != 1:
            return None
        turn = int(quarter.p) % 4
        if turn == 2:
            raise MathError("no finite real value")
        return fmpq({0: 0, 1: 1, 3: -1}[turn])
    sixth = (times if op == "cos" else times - fmpq(1, 2)) * 6
    if sixth.q != 1:
        return None
    turn = int(sixth.p) % 12
    twice = _COSINES[min(turn, 12 - turn)]
    return None if twice is None else fmpq(twice, 2)


class _AsPairs(Mapping[str, AnyNumber]):
    """Rational quantities as pairs without a multiple of pi."""

    def __init__(self, env: Environment) -> None:
        self.env = env

    def __getitem__(self, name: str) -> AnyNumber:
        from flint import fmpq

        value = self.env[name]
        if not isinstance(value, fmpq):
            raise TypeError(name)
        return value, fmpq(0)

    def __iter__(self) -> Iterator[str]:
        return iter(self.env)

    def __len__(self) -> int:
        return len(self.env)


@cache
def _pi_multiples() -> NumberSystem:
    """Return the system of pairs, a number and how many times pi; all else has no value."""
    from flint import fmpq

    from quizgen.maths.numbers import to_rational

    def times(a: AnyNumber, b: AnyNumber) -> AnyNumber:
        """Return the product of two pairs; ``TypeError`` if it has the square of pi."""
        if a[1] and b[1]:
            raise TypeError
        return a[0] * b[0], a[0] * b[1] + a[1] * b[0]

    def over(a: AnyNumber, b: AnyNumber) -> AnyNumber:
        """Return the quotient by a rational number; ``TypeError`` for any other divisor."""
        if b[1] or not b[0]:
            raise TypeError
        return a[0] / b[0], a[1] / b[0]

    def refuse(*_args: AnyNumber) -> AnyNumber:
        """Raise ``TypeError``: the result is no rational combination of 1 and pi."""
        raise TypeError

    own: dict[str, OperatorFunction] = {
        "add": lambda a, b: (a[0] + b[0], a[1] + b[1]),
        "sub": lambda a, b: (a[0] - b[0], a[1] - b[1]),
        "neg": lambda a: (-a[0], -a[1]),
        "mul": times,
        "div": over,
        "pi": lambda: (fmpq(0), fmpq(1)),
    }
    ops = {name: own.get(name, refuse) for name in OPERATORS}
    return NumberSystem("multiples of pi", lambda q: (to_rational(q), fmpq(0)), ops)


def _find_compiler(
    expr: Call, system: NumberSystem
) -> Callable[[Call, NumberSystem], CompiledFormula] | None:
    """Return what compiles an operator that works on more than its arguments' values."""
    if expr.op == "piecewise":
        return _compile_piecewise
    if expr.op in BINDERS:
        return _compile_binder
    if len(expr.args) == 1 and f"list_{expr.op}" in system.ops:
        return _compile_extreme
    if expr.op in _PERIODIC and system.name in _EXACT and "pi" in operators_in(expr.args[0]):
        return _compile_special_angle
    return None


def _compile_extreme(expr: Call, system: NumberSystem) -> CompiledFormula:
    """Return the least or the largest value of one list, or one number itself, compiled."""
    return _compile_call(Call(f"list_{expr.op}", expr.args), system)


def _make_binary_call(op: str, first: Expr, second: Expr) -> Expr:
    """Return an operator applied to two arguments."""
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
    """Return an operator with its operands, compiled by their kinds."""
    op, kinds = system.ops[expr.op], tuple(map(type, expr.args))
    operands = [_compile_operand(arg, system) for arg in expr.args]
    if len(kinds) == 1:
        return _SINGLES[kinds[0]](op, *operands)
    if len(kinds) == 2:
        return _PAIRS[kinds](op, *operands)
    return _compile_many(op, expr.args, system)


def _compile_operand(expr: Expr, system: NumberSystem) -> AnyNumber:
    """Return what an operator is compiled with: a name, a constant or a compiled formula."""
    if isinstance(expr, Sym):
        return expr.name
    return system.constant(expr.value) if isinstance(expr, Num) else compile_nested(expr, system)


def _compile_many(
    op: OperatorFunction, args: Iterable[Expr], system: NumberSystem
) -> CompiledFormula:
    """Return an operator of three or more operands, compiled."""
    parts = [compile_nested(arg, system) for arg in args]
    return lambda env: op(*[part(env) for part in parts])


def _compile_run(
    op: OperatorFunction, args: Iterable[Expr], system: NumberSystem
) -> CompiledFormula:
    """Return a long run of one sign compiled as a loop: nested calls would be too deep."""
    parts = [compile_nested(arg, system) for arg in args]
    return lambda env: reduce(op, (part(env) for part in parts))


def _compile_piecewise(expr: Call, system: NumberSystem) -> CompiledFormula:
    """Return branches compiled so that only the one that applies is computed.

    Arrays compute all of them and select element by element.
    """
    if "piecewise" in system.ops:
        return _compile_many(system.ops["piecewise"], expr.args, system)
    parts = [compile_nested(arg, system) for arg in expr.args]
    pairs = list(zip(parts[:-1:2], parts[1::2], strict=True))
    otherwise = parts[-1]

    def choose(env: Environment) -> AnyNumber:
        """Return the value of the first branch whose condition holds."""
        for value, condition in pairs:
            if system.truth(condition(env)):
                return value(env)
        return otherwise(env)

    return choose


def select_branch(expr: Expr, env: Environment, system: NumberSystem) -> Expr:
    """Return a formula with each ``piecewise`` replaced by the branch that applies.

    A worked solution shows the branch alone.
    """
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
    """Return what computes each operator of the table in a number system.

    Parameters
    ----------
    system : str
        Its name in the table.
    *sources : module
        Where functions are looked up, in order.
    **own : callable
        Functions that none of them has, under the name that the table gives.

    Raises
    ------
    StopIteration
        If nothing has a function.
    """
    found = {}
    for row in OPERATORS.values():
        if system not in row.absent:
            name = row.function_in(system)
            found[row.name] = own[name] if name in own else _looked_up(name, sources)
    return found


def _looked_up(name: str, sources: tuple[object, ...]) -> OperatorFunction:
    """Return the function of a name from the first source that has it."""
    op: OperatorFunction = next(
        getattr(source, name) for source in sources if hasattr(source, name)
    )
    return op


@cache
def exact_system() -> NumberSystem:
    """Return exact rationals (``flint.fmpq``), and certified balls (``flint.arb``) beyond them."""
    from flint import fmpq

    from quizgen.maths import exact as own
    from quizgen.maths import further, special
    from quizgen.maths.list_operators import build_list_functions
    from quizgen.maths.numbers import to_rational
    from quizgen.maths.precision import at_working_precision

    lists = build_list_functions(own.square_root, fmpq)
    ops = operator_functions(
        "exact", own, operator, special, further.FUNCTIONS, own.BALLS, **_LOGIC, **lists
    )
    return NumberSystem("exact", to_rational, ops, guard=at_working_precision)


@cache
def float64_system() -> NumberSystem:
    """Return Python floats: the fast approximation used by figures."""
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
    functions = operator_functions(
        "floats",
        math,
        operator,
        builtins,
        **_LOGIC,
        **own,
        **{name: _approximate(name) for name in _list_special_names()},
    )
    return NumberSystem("float64", float, functions)


def _list_special_names() -> list[str]:
    """Return operators that neither Python's standard library nor NumPy has."""
    return [
        row.name
        for row in OPERATORS.values()
        if row.typed is OperatorSyntax.FUNCTION
        and "exact" in row.called
        and "floats" not in row.called
    ]


def _approximate(name: str) -> OperatorFunction:
    """Return the operator that gives the float nearest to what another gives as a ball.

    Raises ``ValueError`` where it has no value, as the standard library does.
    """

    def apply(*args: float) -> float:
        """Return the float nearest to the exact result for floats taken as exact rationals."""
        from flint import fmpq

        from quizgen.maths.numbers import to_float
        from quizgen.maths.precision import working_precision

        op = exact_system().ops[name]
        try:
            with working_precision():
                return to_float(op(*(fmpq(*float(arg).as_integer_ratio()) for arg in args)))
        except MathError as error:
            raise ValueError(str(error)) from error

    return apply


def round_to_float32(x: float) -> float:
    """Return the nearest float32."""
    return float(unpack("f", pack("f", x))[0])


@cache
def float32_system() -> NumberSystem:
    """Return numbers rounded to float32 after every operation; truth values stay."""

    def rounding(name: str, op: OperatorFunction) -> OperatorFunction:
        """Return an operator whose result is rounded, unless it is a condition."""
        return op if name in CONDITIONS | {"sort"} else lambda *args: round_to_float32(op(*args))

    ops = {name: rounding(name, op) for name, op in float64_system().ops.items()}
    return NumberSystem("float32", lambda q: round_to_float32(float(q)), ops)


@cache
def array_system(bits: int) -> NumberSystem:
    """Return NumPy arrays of 32 or 64 bits, which compute the formula as it is printed."""
    import numpy as np

    number = np.float32 if bits == 32 else np.float64
    own: dict[str, OperatorFunction] = {
        "erf": _find_special_function("erf", bits),
        "erfc": _find_special_function("erfc", bits),
        **{
            name: np.vectorize(_approximate(name), otypes=[number])
            for name in _list_special_names()
        },
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
    """Return SciPy's function if SciPy is there, else the C library's, element by element."""
    import numpy as np

    try:
        import scipy.special
    except ImportError:
        slow = np.vectorize(getattr(math, name), otypes=[np.float64])
        return lambda x: slow(x).astype(np.float32 if bits == 32 else np.float64)
    function: OperatorFunction = getattr(scipy.special, name)
    return function


def _select_array_branch(*args: AnyNumber) -> AnyNumber:
    """Return, element by element, the value of the first branch whose condition holds."""
    import numpy as np

    value = args[-1]
    for chosen, condition in zip(args[-3::-2], args[-2::-2], strict=True):
        value = np.where(condition, chosen, value)
    return value


@cache
def sympy_system() -> NumberSystem:
    """Return SymPy expressions on exact rationals."""
    import sympy

    own: dict[str, OperatorFunction] = {
        **{name: sympy.Function(name) for name in UNEVALUATED},
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
    """Return the value of a tree (compile it instead when it is needed often).

    Raises
    ------
    MathError
        If there is no finite real value.
    """
    try:
        return compile_expr(expr, system or exact_system())(env)
    except (ZeroDivisionError, OverflowError) as error:
        raise MathError(str(error)) from error
