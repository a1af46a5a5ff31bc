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

from quizgen.core.errors import BankError
from quizgen.maths.lists import ListFunction
from quizgen.maths.operators import OPERATORS
from quizgen.maths.tree import Call, Expr, Num, Sym, make_number

_DOUBLE = 53
_ONE = Num(Fraction(1))


def _iter_sympy_classes() -> Iterator[tuple[type, str]]:
    """Yield SymPy's classes that are operators of ours, by the name that the table gives."""
    for row in OPERATORS.values():
        kind = getattr(sympy, row.function_in("sympy"), None)
        if isinstance(kind, type):
            yield kind, row.name


def from_sympy(expression: sympy.Basic) -> Expr:
    """Return the formula tree of a SymPy expression.

    Parameters
    ----------
    expression : sympy.Basic, int or float
        Written under ``sympy.evaluate(False)``.

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
    what = f"no formula for SymPy's {type(expression).__name__}: {expression}"
    raise BankError(f"{what} (docs/functions.md lists what there is)")


def _convert_arguments(expression: sympy.Basic) -> tuple[Expr, ...]:
    """Return the trees of an expression's arguments."""
    return tuple(from_sympy(arg) for arg in expression.args)


def _convert_symbol(expression: sympy.Basic) -> Expr:
    """Return a quantity."""
    return Sym(expression.name)


def _convert_rational(expression: sympy.Basic) -> Expr:
    """Return an exact number."""
    return Num(Fraction(int(expression.p), int(expression.q)))


def _convert_float(expression: sympy.Basic) -> Expr:
    """Return the decimal that was typed: 2.2 is 11/5, not the nearest binary number.

    Raises
    ------
    BankError
        If it is infinite or no number.
    """
    if not expression.is_finite:
        raise BankError(f"no formula for the number {expression}")
    double = expression._prec <= _DOUBLE  # noqa: SLF001 - SymPy has no public name for it
    typed = repr(float(expression)) if double else str(expression)
    return Num(Fraction(typed), decimal=True)


def _convert_pi(_expression: sympy.Basic) -> Expr:
    """Return the constant pi."""
    return Call("pi", ())


def _convert_euler_number(_expression: sympy.Basic) -> Expr:
    """Return e as ``exp(1)``."""
    return Call("exp", (_ONE,))


def _convert_sum(expression: sympy.Basic) -> Expr:
    """Return the tree of a sum; a difference, if its second term has a minus sign."""
    first, *rest = expression.args
    total = [from_sympy(first)]
    for term in rest:
        minus, value = _split_sign(term)
        if minus and len(total) == 1:
            total = [Call("sub", (total[0], value))]
        else:
            total.append(Call("neg", (value,)) if minus else value)
    return total[0] if len(total) == 1 else Call("add", tuple(total))


def _split_sign(term: sympy.Basic) -> tuple[bool, Expr]:
    """Return whether a later term of a sum has a minus sign, and the term without it."""
    value = from_sympy(term)
    if isinstance(value, Num) and value.value < 0:
        return True, Num(-value.value, value.decimal)
    if isinstance(value, Call) and value.op == "neg":
        return True, value.args[0]
    return False, value


def _convert_product(expression: sympy.Basic) -> Expr:
    """Return a product or quotient in the order of its factors, with a sign before all of it."""
    result: Expr | None = None
    minus = False
    for factor in expression.args:
        value, below = _convert_factor(factor)
        if result is None and not below and isinstance(value, Num) and value.value < 0:
            minus, value = not minus, Num(-value.value, value.decimal)
            if value == _ONE:
                continue
        result = _divide_trees(result or _ONE, value) if below else _multiply_trees(result, value)
        if isinstance(result, Call) and result.op == "neg":
            minus, result = not minus, result.args[0]
    product = result if result is not None else _ONE
    return Call("neg", (product,)) if minus else product


def _convert_factor(factor: sympy.Basic) -> tuple[Expr, bool]:
    """Return a factor, and whether its negative power puts it below the bar."""
    below = _find_denominator(factor)
    return (from_sympy(factor), False) if below is None else (below, True)


def _find_denominator(expression: sympy.Basic) -> Expr | None:
    """Return what stands below the bar of ``1/something``; None if it is no such power."""
    if not isinstance(expression, sympy.Pow) or expression.base is sympy.S.Exp1:
        return None
    exponent = expression.exp
    if not (isinstance(exponent, sympy.Rational | sympy.Float) and exponent.is_negative):
        return None
    return _build_power(from_sympy(expression.base), from_sympy(-exponent))


def _multiply_trees(result: Expr | None, value: Expr) -> Expr:
    """Return a product with one factor more; ``result`` is None before the first."""
    if result is None:
        return value
    if isinstance(result, Call) and result.op == "mul":
        return Call("mul", (*result.args, value))
    return Call("mul", (result, value))


def _divide_trees(top: Expr, bottom: Expr) -> Expr:
    """Return a quotient; ``a/b/c`` becomes one fraction."""
    if isinstance(top, Call) and top.op == "div" and top.args[0] != _ONE:
        return Call("div", (top.args[0], _multiply_trees(top.args[1], bottom)))
    return Call("div", (top, bottom))


def _convert_power(expression: sympy.Basic) -> Expr:
    """Return a power, root, quotient or exponential function."""
    if expression.base is sympy.S.Exp1:
        return Call("exp", (from_sympy(expression.exp),))
    below = _find_denominator(expression)
    if below is not None:
        return Call("div", (_ONE, below))
    return _build_power(from_sympy(expression.base), from_sympy(expression.exp))


def _build_power(base: Expr, exponent: Expr) -> Expr:
    """Return a power; a root for the exponent 1/2."""
    if exponent == _ONE:
        return base
    if exponent == Num(Fraction(1, 2)):
        return Call("sqrt", (base,))
    return Call("pow", (base, exponent))


def _convert_logarithm(expression: sympy.Basic) -> Expr:
    """Return a logarithm; to bases without an operator of their own as a quotient."""
    value, *base = _convert_arguments(expression)
    if not base:
        return Call("ln", (value,))
    if isinstance(base[0], Num) and base[0].value in {2, 10}:
        return Call(f"log{base[0].value}", (value,))
    return Call("div", (Call("ln", (value,)), Call("ln", (base[0],))))


def _make_extremum_converter(op: str) -> Callable[[sympy.Basic], Expr]:
    """Return the rule for Max or Min, which SymPy sorts; colour channels go back to R, G, B."""

    def rule(expression: sympy.Basic) -> Expr:
        """Return the largest or smallest of the arguments; a single one is itself."""
        args = _convert_arguments(expression)
        if {getattr(arg, "name", "") for arg in args} == set("RGB"):
            args = tuple(Sym(channel) for channel in "RGB")
        return args[0] if len(args) == 1 else Call(op, args)

    return rule


def _convert_piecewise(expression: sympy.Basic) -> Expr:
    """Return the branches, each value before its condition, and the last value.

    Raises
    ------
    BankError
        If the last branch has a condition.
    """
    args: list[Expr] = []
    for value, condition in expression.args:
        args.append(_NOTHING if _has_no_end(value) else from_sympy(value))
        if isinstance(condition, BooleanTrue):
            return Call("piecewise", tuple(args)) if len(args) > 1 else args[0]
        args.append(from_sympy(condition))
    raise BankError(f"the last branch of {expression} must hold otherwise: end with (..., True)")


_NOTHING = Call("div", (_ONE, Num(Fraction(0))))
"""What has no value: a draw that leads there is thrown away."""


def _has_no_end(value: sympy.Basic) -> bool:
    """Return whether a value is an infinite sum that SymPy could not add up: it may diverge."""
    sums = value.atoms(sympy.Sum, sympy.Product) if hasattr(value, "atoms") else ()
    return any(bound.is_infinite for one in sums for limit in one.limits for bound in limit[1:])


def _make_binder_converter(op: str) -> Callable[[sympy.Basic], Expr]:
    """Return the rule for sums, products and integrals with finite bounds, innermost first."""

    def rule(expression: sympy.Basic) -> Expr:
        """Return a sum, product or integral as nested calls, a call for each limit."""
        body = from_sympy(expression.function)
        if isinstance(body, Call) and body.op == "mul" and body.args[0] == make_number(1):
            # SymPy puts a 1 before what is summed where it must not evaluate
            body = body.args[1] if len(body.args) == 2 else Call("mul", body.args[1:])
        for limit in expression.limits:
            if len(limit) != 3 or any(bound.is_infinite for bound in limit[1:]):
                what = f"{expression} has no closed form, or lacks finite bounds"
                hint = "where it needs a sign, say so: symbols('a', positive=True)"
                raise BankError(f"{what} ({hint})")
            name, low, high = limit
            body = Call(op, (Sym(name.name), from_sympy(low), from_sympy(high), body))
        return body

    return rule


def _convert_own_function(expression: sympy.Basic) -> Expr:
    """Return ``Function("t_quantile")(p, n)`` as a call: an operator that SymPy has not."""
    name = expression.func.__name__
    row = OPERATORS.get(name)
    if row is None or not row.least <= len(expression.args) <= row.most:
        raise BankError(f"no formula for {expression}: write a function of your own in Python")
    return Call(name, _convert_arguments(expression))


REWRITES: dict[type, type] = {
    sympy.coth: sympy.tanh,
    sympy.sech: sympy.cosh,
    sympy.csch: sympy.sinh,
    sympy.acot: sympy.atan,
    sympy.asec: sympy.acos,
    sympy.acsc: sympy.asin,
    sympy.Heaviside: sympy.Piecewise,
    sympy.erfcinv: sympy.erfinv,
    sympy.RisingFactorial: sympy.gamma,
    sympy.FallingFactorial: sympy.gamma,
    sympy.sinc: sympy.sin,
    sympy.frac: sympy.floor,
    sympy.catalan: sympy.binomial,
    sympy.acoth: sympy.log,
    sympy.asech: sympy.log,
    sympy.acsch: sympy.log,
    sympy.erf2: sympy.erf,
    sympy.trigamma: sympy.polygamma,
    sympy.jn: sympy.besselj,
    sympy.yn: sympy.bessely,
    sympy.KroneckerDelta: sympy.Piecewise,
}
"""Functions that are said by another one."""


def _rewrite_function(expression: sympy.Basic) -> Expr:
    """Return the formula of a function by way of others, as ``REWRITES`` lists them.

    Raises ``BankError`` if SymPy cannot rewrite it.
    """
    kind = REWRITES[type(expression)]
    other = expression.rewrite(kind)
    if type(other) is type(expression):  # SymPy wants to know that the order of yn is whole
        order, *rest = expression.args
        whole = sympy.Dummy(integer=True)
        other = expression.func(whole, *rest).rewrite(kind).xreplace({whole: order})
    if type(other) is type(expression):
        raise BankError(f"no formula for {expression}")
    return from_sympy(other)


def _make_function_converter(op: str) -> Callable[[sympy.Basic], Expr]:
    """Return the rule for a function that both have."""
    row = OPERATORS[op]

    def rule(expression: sympy.Basic) -> Expr:
        """Return the call; ``BankError`` for more arguments than ours takes."""
        args = _convert_arguments(expression)
        if not row.least <= len(args) <= row.most:
            raise BankError(f"no formula for {expression}: {op} takes {row.least} argument(s) here")
        return Call(op, args)

    return rule


def _reject_expression(expression: sympy.Basic) -> Expr:
    """Raise for what is no formula.

    Raises
    ------
    BankError
        That names it.
    """
    raise BankError(f"no formula for {expression}")


_RULES: dict[type, Callable[[sympy.Basic], Expr]] = {
    **{kind: _make_function_converter(op) for kind, op in _iter_sympy_classes()},
    sympy.Symbol: _convert_symbol,
    sympy.Rational: _convert_rational,
    sympy.Float: _convert_float,
    type(sympy.pi): _convert_pi,
    type(sympy.E): _convert_euler_number,
    type(sympy.EulerGamma): lambda _: Call("neg", (Call("digamma", (_ONE,)),)),
    type(sympy.GoldenRatio): lambda _: from_sympy((1 + sympy.sqrt(5)) / 2),
    sympy.Add: _convert_sum,
    sympy.Mul: _convert_product,
    sympy.Pow: _convert_power,
    sympy.log: _convert_logarithm,
    sympy.Max: _make_extremum_converter("max"),
    sympy.Min: _make_extremum_converter("min"),
    sympy.Piecewise: _convert_piecewise,
    BooleanTrue: _reject_expression,
    BooleanFalse: _reject_expression,
    AppliedUndef: _convert_own_function,
    sympy.Sum: _make_binder_converter("sum"),
    sympy.Product: _make_binder_converter("product"),
    sympy.Integral: _make_binder_converter("integral"),
    **dict.fromkeys(REWRITES, _rewrite_function),
    ListFunction: lambda expression: Call(expression.op, _convert_arguments(expression)),
}
