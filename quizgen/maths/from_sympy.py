"""From a SymPy expression to a formula tree, in the order in which it was written.

Solvers write their formulas under ``sympy.evaluate(False)``; SymPy then keeps the order of sums
and products, and stores a quotient as a product with a power -1 and a difference as a sum with a
product by -1. Here they become quotients and differences again. SymPy sorts the arguments of
``Max``, ``Min``, ``And`` and ``Or`` whatever one does; numbers come first there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction

import sympy
from sympy.core.function import AppliedUndef
from sympy.logic.boolalg import BooleanFalse, BooleanTrue

from quizgen.errors import BankError
from quizgen.maths.operators import OPERATORS
from quizgen.maths.tree import Call, Expr, Num, Sym

_DOUBLE = 53
_ONE = Num(Fraction(1))


def _classes() -> Iterator[tuple[type, str]]:
    """SymPy's classes that are operators of ours, by the name that the table gives."""
    for row in OPERATORS.values():
        kind = getattr(sympy, row.function_in("sympy"), None)
        if isinstance(kind, type):
            yield kind, row.name


def convert(expression: sympy.Basic) -> Expr:
    """Convert a SymPy expression.

    Parameters
    ----------
    expression : sympy.Basic, int or float
        Written under ``sympy.evaluate(False)``.

    Returns
    -------
    Expr
        The formula tree.

    Raises
    ------
    BankError
        If the expression holds anything outside the closed list of operators.
    """
    if isinstance(expression, int | float) and not isinstance(expression, bool):
        expression = (
            sympy.Integer(expression) if isinstance(expression, int) else sympy.Float(expression)
        )
    for kind in type(expression).__mro__:
        rule = _RULES.get(kind)
        if rule is not None:
            return rule(expression)
    raise BankError(f"no formula for SymPy's {type(expression).__name__}: {expression}")


def _converted(expression: sympy.Basic) -> tuple[Expr, ...]:
    return tuple(convert(arg) for arg in expression.args)


def _symbol(expression: sympy.Basic) -> Expr:
    return Sym(expression.name)


def _rational(expression: sympy.Basic) -> Expr:
    return Num(Fraction(int(expression.p), int(expression.q)))


def _float(expression: sympy.Basic) -> Expr:
    """Take the decimal that was typed: 2.2 is 11/5, not the nearest binary number."""
    if not expression.is_finite:
        raise BankError(f"no formula for the number {expression}")
    double = expression._prec <= _DOUBLE  # noqa: SLF001 - SymPy has no public name for it
    typed = repr(float(expression)) if double else str(expression)
    return Num(Fraction(typed), decimal=True)


def _pi(_expression: sympy.Basic) -> Expr:
    return Call("pi", ())


def _e(_expression: sympy.Basic) -> Expr:
    return Call("exp", (_ONE,))


def _add(expression: sympy.Basic) -> Expr:
    first, *rest = expression.args
    total = [convert(first)]
    for term in rest:
        minus, value = _signed(term)
        if minus and len(total) == 1:
            total = [Call("sub", (total[0], value))]
        else:
            total.append(Call("neg", (value,)) if minus else value)
    return total[0] if len(total) == 1 else Call("add", tuple(total))


def _signed(term: sympy.Basic) -> tuple[bool, Expr]:
    """Split the sign off a later term of a sum."""
    value = convert(term)
    if isinstance(value, Num) and value.value < 0:
        return True, Num(-value.value, value.decimal)
    if isinstance(value, Call) and value.op == "neg":
        return True, value.args[0]
    return False, value


def _mul(expression: sympy.Basic) -> Expr:
    result: Expr | None = None
    minus = False
    for factor in expression.args:
        value, below = _factor(factor)
        if result is None and not below and isinstance(value, Num) and value.value < 0:
            minus, value = not minus, Num(-value.value, value.decimal)
            if value == _ONE:
                continue
        result = _over(result or _ONE, value) if below else _times(result, value)
        if isinstance(result, Call) and result.op == "neg":
            minus, result = not minus, result.args[0]
    product = result if result is not None else _ONE
    return Call("neg", (product,)) if minus else product


def _factor(factor: sympy.Basic) -> tuple[Expr, bool]:
    """Convert a factor; a factor with a negative power goes below the bar."""
    below = _reciprocal(factor)
    return (convert(factor), False) if below is None else (below, True)


def _reciprocal(expression: sympy.Basic) -> Expr | None:
    """Find what stands below the bar of ``1/something``."""
    if not isinstance(expression, sympy.Pow) or expression.base is sympy.S.Exp1:
        return None
    exponent = expression.exp
    if not (isinstance(exponent, sympy.Rational | sympy.Float) and exponent.is_negative):
        return None
    return _power(convert(expression.base), convert(-exponent))


def _times(result: Expr | None, value: Expr) -> Expr:
    if result is None:
        return value
    if isinstance(result, Call) and result.op == "mul":
        return Call("mul", (*result.args, value))
    return Call("mul", (result, value))


def _over(top: Expr, bottom: Expr) -> Expr:
    """Divide; ``a/b/c`` becomes one fraction."""
    if isinstance(top, Call) and top.op == "div" and top.args[0] != _ONE:
        return Call("div", (top.args[0], _times(top.args[1], bottom)))
    return Call("div", (top, bottom))


def _pow(expression: sympy.Basic) -> Expr:
    if expression.base is sympy.S.Exp1:
        return Call("exp", (convert(expression.exp),))
    below = _reciprocal(expression)
    if below is not None:
        return Call("div", (_ONE, below))
    return _power(convert(expression.base), convert(expression.exp))


def _power(base: Expr, exponent: Expr) -> Expr:
    if exponent == _ONE:
        return base
    if exponent == Num(Fraction(1, 2)):
        return Call("sqrt", (base,))
    return Call("pow", (base, exponent))


def _log(expression: sympy.Basic) -> Expr:
    value, *base = _converted(expression)
    if not base:
        return Call("ln", (value,))
    if isinstance(base[0], Num) and base[0].value in {2, 10}:
        return Call(f"log{base[0].value}", (value,))
    return Call("div", (Call("ln", (value,)), Call("ln", (base[0],))))


def _ordered(op: str) -> Callable[[sympy.Basic], Expr]:
    """Max and Min come sorted; colour channels go back to R, G, B."""

    def rule(expression: sympy.Basic) -> Expr:
        args = _converted(expression)
        if {getattr(arg, "name", "") for arg in args} == set("RGB"):
            args = tuple(Sym(channel) for channel in "RGB")
        return args[0] if len(args) == 1 else Call(op, args)

    return rule


def _piecewise(expression: sympy.Basic) -> Expr:
    args: list[Expr] = []
    for value, condition in expression.args:
        args.append(convert(value))
        if isinstance(condition, BooleanTrue):
            return Call("piecewise", tuple(args)) if len(args) > 1 else args[0]
        args.append(convert(condition))
    raise BankError(f"the last branch of {expression} must hold otherwise: end with (..., True)")


def _named(op: str) -> Callable[[sympy.Basic], Expr]:
    return lambda expression: Call(op, _converted(expression))


def _unknown(expression: sympy.Basic) -> Expr:
    raise BankError(f"no formula for {expression}")


_RULES: dict[type, Callable[[sympy.Basic], Expr]] = {
    **{kind: _named(op) for kind, op in _classes()},
    sympy.Symbol: _symbol,
    sympy.Rational: _rational,
    sympy.Float: _float,
    type(sympy.pi): _pi,
    type(sympy.E): _e,
    sympy.Add: _add,
    sympy.Mul: _mul,
    sympy.Pow: _pow,
    sympy.log: _log,
    sympy.Max: _ordered("max"),
    sympy.Min: _ordered("min"),
    sympy.Piecewise: _piecewise,
    BooleanTrue: _unknown,
    BooleanFalse: _unknown,
    AppliedUndef: _unknown,
}
