"""Complex numbers as pairs of exact numbers: what a typed formula of ``i`` comes to."""

from __future__ import annotations

from functools import cache, reduce
from typing import TypeAlias

from flint import fmpq

from quizgen.core.errors import MathError
from quizgen.maths.constants import bounded_exact_system
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.number_systems import NumberSystem, OperatorFunction, compile_expr
from quizgen.maths.numbers import to_rational
from quizgen.maths.operators import OPERATORS
from quizgen.maths.precision import working_precision
from quizgen.maths.tree import Expr, Sym, substitute
from quizgen.maths.values import AnyNumber, Value

ComplexValue: TypeAlias = tuple[Value, Value]
"""Real and imaginary part."""

LARGEST_POWER = 200
"""Largest whole exponent."""


def evaluate_complex(tree: Expr, units: frozenset[str]) -> ComplexValue:
    """Return the parts of a formula in which some names stand for the imaginary unit.

    Raises
    ------
    FormulaReadError
        If it has no value.
    """
    bound = substitute(tree, dict.fromkeys(units, Sym("i")))
    try:
        with working_precision():
            value: ComplexValue = compile_expr(bound, complex_system())({"i": (fmpq(0), fmpq(1))})
            return value
    except (MathError, ZeroDivisionError, OverflowError, ValueError, TypeError) as error:
        raise FormulaReadError("no-value", 1, str(error)) from None


@cache
def complex_system() -> NumberSystem:
    """Return the system of pairs of exact numbers; real functions are the exact system's."""
    real = bounded_exact_system().ops

    def apply_real(name: str) -> AnyNumber:
        """Return a real operator as one of pairs, for arguments that are all real."""

        def apply(*args: ComplexValue) -> ComplexValue:
            """Return its value as a pair; ``MathError`` if an argument is not real."""
            if any(arg[1] != 0 for arg in args):
                raise MathError("a function of a complex number")
            found = real[name](*(arg[0] for arg in args))
            if isinstance(found, bool):
                raise MathError("a statement")
            return found, fmpq(0)

        return apply

    own: dict[str, OperatorFunction] = {
        "add": lambda a, b: (a[0] + b[0], a[1] + b[1]),
        "sub": lambda a, b: (a[0] - b[0], a[1] - b[1]),
        "neg": lambda a: (-a[0], -a[1]),
        "mul": multiply,
        "div": _divide,
        "pow": _raise,
        "exp": _exponentiate,
        "sqrt": _take_root,
    }
    ops = {name: own.get(name) or apply_real(name) for name in OPERATORS if name in real}
    ops |= own
    return NumberSystem("complex", lambda q: (to_rational(q), fmpq(0)), ops)


def multiply(a: ComplexValue, b: ComplexValue) -> ComplexValue:
    """Return the product of two complex numbers."""
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def _divide(a: ComplexValue, b: ComplexValue) -> ComplexValue:
    """Return the quotient of two complex numbers; ``MathError`` if the divisor is zero."""
    divide = bounded_exact_system().ops["div"]
    size = b[0] * b[0] + b[1] * b[1]
    top = multiply(a, (b[0], -b[1]))
    return divide(top[0], size), divide(top[1], size)


def _raise(a: ComplexValue, b: ComplexValue) -> ComplexValue:
    """Return a power: of reals any that is real, of a complex number a whole one.

    Raises ``MathError`` for any other power, and for one above ``LARGEST_POWER``.
    """
    ops = bounded_exact_system().ops
    if a[1] == 0 and b[1] == 0:
        return ops["pow"](a[0], b[0]), fmpq(0)
    power = b[0]
    if b[1] != 0 or not isinstance(power, fmpq) or power.q != 1 or abs(power) > LARGEST_POWER:
        raise MathError("a power that is no whole number")
    one: ComplexValue = (fmpq(1), fmpq(0))
    raised = reduce(multiply, [a] * abs(int(power.p)), one)
    return _divide(one, raised) if power < 0 else raised


def _exponentiate(a: ComplexValue) -> ComplexValue:
    """Return e to the power of a complex number, by Euler's formula."""
    ops = bounded_exact_system().ops
    size = ops["exp"](a[0])
    return size * ops["cos"](a[1]), size * ops["sin"](a[1])


def _take_root(a: ComplexValue) -> ComplexValue:
    """Return the principal square root of a real number; ``MathError`` if it is not real."""
    ops = bounded_exact_system().ops
    if a[1] == 0 and a[0] < 0:
        return fmpq(0), ops["sqrt"](-a[0])
    if a[1] == 0:
        return ops["sqrt"](a[0]), fmpq(0)
    raise MathError("a root of a complex number")
