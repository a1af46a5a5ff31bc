"""The derivative of a formula by the rules of calculus, without SymPy: of what a student typed."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from quizgen.core.errors import MathError
from quizgen.maths.tidy import tidy_formula
from quizgen.maths.tree import Call, Expr, Num, Sym, make_number, names_in, substitute

_ZERO, _ONE = Num(Fraction(0)), Num(Fraction(1))


def _square(u: Expr) -> Expr:
    """Return the square of a formula."""
    return Call("pow", (u, make_number(2)))


def _over_root(sign: str, u: Expr) -> Expr:
    """Return 1 over the root of 1 minus (``sub``) or plus (``add``) the square of a formula."""
    return Call("div", (_ONE, Call("sqrt", (Call(sign, (_ONE, _square(u))),))))


def _over_ln(base: int, u: Expr) -> Expr:
    """Return the derivative of a logarithm to a base."""
    return Call("div", (_ONE, Call("mul", (u, Call("ln", (make_number(base),))))))


_RULES: dict[str, Callable[[Expr], Expr]] = {
    "exp": lambda u: Call("exp", (u,)),
    "ln": lambda u: Call("div", (_ONE, u)),
    "log2": lambda u: _over_ln(2, u),
    "log10": lambda u: _over_ln(10, u),
    "sqrt": lambda u: Call("div", (_ONE, Call("mul", (make_number(2), Call("sqrt", (u,)))))),
    "sin": lambda u: Call("cos", (u,)),
    "cos": lambda u: Call("neg", (Call("sin", (u,)),)),
    "tan": lambda u: Call("add", (_ONE, _square(Call("tan", (u,))))),
    "asin": lambda u: _over_root("sub", u),
    "acos": lambda u: Call("neg", (_over_root("sub", u),)),
    "atan": lambda u: Call("div", (_ONE, Call("add", (_ONE, _square(u))))),
    "sinh": lambda u: Call("cosh", (u,)),
    "cosh": lambda u: Call("sinh", (u,)),
    "tanh": lambda u: Call("sub", (_ONE, _square(Call("tanh", (u,))))),
    "asinh": lambda u: _over_root("add", u),
    "abs": lambda u: Call("sign", (u,)),
    "erf": lambda u: Call(
        "div",
        (
            Call("mul", (make_number(2), Call("exp", (Call("neg", (_square(u),)),)))),
            Call("sqrt", (Call("pi", ()),)),
        ),
    ),
}
"""Function of one argument to its derivative by that."""


def differentiate(expr: Expr, name: str) -> Expr:
    """Return the derivative of a formula by one of its names.

    Raises
    ------
    MathError
        If there is no rule for an operator in it.
    """
    return tidy_formula(_differentiate(expr, name))


def _differentiate(expr: Expr, name: str) -> Expr:
    """Return the derivative, not yet tidied."""
    if not isinstance(expr, Call) or name not in names_in(expr):
        return _ONE if expr == Sym(name) else _ZERO
    match expr:
        case Call(op="add" | "sub" | "neg"):
            found = Call(expr.op, tuple(_differentiate(arg, name) for arg in expr.args))
        case Call(op="mul"):
            found = _differentiate_product(expr.args, name)
        case Call(op="div", args=(top, below)):
            parts = [
                Call("mul", (_differentiate(top, name), below)),
                Call("mul", (top, _differentiate(below, name))),
            ]
            found = Call("div", (Call("sub", tuple(parts)), _square(below)))
        case Call(op="pow", args=(base, exponent)):
            found = _differentiate_power(base, exponent, name)
        case Call(op="integral", args=(Sym(bound), low, high, inner)):
            found = _differentiate_integral((bound, inner), (low, high), name)
        case Call(args=(inner,)) if expr.op in _RULES:
            found = Call("mul", (_RULES[expr.op](inner), _differentiate(inner, name)))
        case _:
            raise MathError(f"no rule for the derivative of {expr.op}")
    return found


def _differentiate_product(factors: tuple[Expr, ...], name: str) -> Call:
    """Return the derivative of a product: each factor's in turn, times the others."""
    terms = [
        Call("mul", (*factors[:place], _differentiate(factor, name), *factors[place + 1 :]))
        for place, factor in enumerate(factors)
    ]
    return Call("add", tuple(terms))


def _differentiate_power(base: Expr, exponent: Expr, name: str) -> Call:
    """Return the derivative of a power; by way of the exponential if its exponent varies."""
    if name in names_in(exponent):
        rate = _differentiate(Call("mul", (exponent, Call("ln", (base,)))), name)
        return Call("mul", (Call("pow", (base, exponent)), rate))
    lower = Call("pow", (base, Call("sub", (exponent, _ONE))))
    return Call("mul", (exponent, lower, _differentiate(base, name)))


def _differentiate_integral(of: tuple[str, Expr], ends: tuple[Expr, Expr], name: str) -> Call:
    """Return the derivative of an integral by what stands in its bounds: the fundamental theorem.

    ``of`` is what is integrated, after the name that varies. Raises ``MathError`` if the other
    name stands in it, too.
    """
    bound, inner = of
    if name in names_in(inner) - {bound}:
        raise MathError("no rule for the derivative of an integral over another name")
    low, high = (
        Call("mul", (substitute(inner, {bound: end}), _differentiate(end, name))) for end in ends
    )
    return Call("sub", (high, low))
