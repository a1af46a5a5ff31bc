"""Generic slips as small changes of a formula: the wrong formulas that a slip would compute."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction

from quizgen.maths.tree import Call, Expr, Num, Sym

Variant = tuple[str, str, Expr]
"""Note, the name or operator concerned, and the changed formula."""

TWO = Num(Fraction(2))
HALF_TURN = Num(Fraction(180))
PI = Call("pi", ())


def variants(expr: Expr, alike: Mapping[str, list[str]]) -> Iterator[Variant]:
    """Every formula that differs by one slip.

    Parameters
    ----------
    expr : Expr
        The right formula.
    alike : mapping of str to list of str
        Quantity name to other known quantities of the same dimension.
    """
    if isinstance(expr, Sym):
        for other in alike.get(expr.name, ()):
            yield "wrong-parameter", f"{other} / {expr.name}", Sym(other)
    if not isinstance(expr, Call):
        return
    local = _LOCAL.get(expr.op)
    if local is not None:
        yield from local(expr)
    for position, arg in enumerate(expr.args):
        for note, detail, changed in variants(arg, alike):
            yield note, detail, _with(expr, position, changed)


def _with(expr: Call, position: int, arg: Expr) -> Call:
    return Call(expr.op, (*expr.args[:position], arg, *expr.args[position + 1 :]))


def _without(expr: Call, position: int) -> Expr:
    rest = (*expr.args[:position], *expr.args[position + 1 :])
    return rest[0] if len(rest) == 1 else Call(expr.op, rest)


def _sum(expr: Call) -> Iterator[Variant]:
    for position, term in enumerate(expr.args):
        yield "term-left-out", "+", _without(expr, position)
        yield "operator", "+ / -", _with(expr, position, Call("neg", (term,)))


def _difference(expr: Call) -> Iterator[Variant]:
    first, second = expr.args
    yield "operator", "- / +", Call("add", (first, second))
    yield "operands", "-", Call("sub", (second, first))
    yield "term-left-out", "-", first
    yield "term-left-out", "-", second


def _product(expr: Call) -> Iterator[Variant]:
    for position, factor in enumerate(expr.args):
        rest = _without(expr, position)
        yield "factor-left-out", "*", rest
        yield "operator", "* / ÷", Call("div", (rest, factor))


def _quotient(expr: Call) -> Iterator[Variant]:
    first, second = expr.args
    yield "ratio-inverted", "/", Call("div", (second, first))
    yield "operator", "÷ / *", Call("mul", (first, second))
    yield "factor-left-out", "/", first


def _power(expr: Call) -> Iterator[Variant]:
    base, exponent = expr.args
    note = "square-forgotten" if exponent == TWO else "exponent-forgotten"
    yield note, "^", base
    yield "exponent-inverted", "^", Call("pow", (base, Call("div", (Num(Fraction(1)), exponent))))
    yield "exponent-as-factor", "^", Call("mul", (base, exponent))


def _root(expr: Call) -> Iterator[Variant]:
    yield "root-forgotten", "sqrt", expr.args[0]


def _trigonometry(expr: Call) -> Iterator[Variant]:
    (arg,) = expr.args
    for scale in (Call("div", (PI, HALF_TURN)), Call("div", (HALF_TURN, PI))):
        yield "degrees-radians", expr.op, Call(expr.op, (Call("mul", (arg, scale)),))
    for other in _ROTATED[expr.op]:
        yield "function", f"{other} / {expr.op}", Call(other, (arg,))


def _inverse_trigonometry(expr: Call) -> Iterator[Variant]:
    for scale in (Call("div", (PI, HALF_TURN)), Call("div", (HALF_TURN, PI))):
        yield "degrees-radians", expr.op, Call("mul", (expr, scale))


def _logarithm(expr: Call) -> Iterator[Variant]:
    for other in ("ln", "log2", "log10"):
        if other != expr.op:
            yield "log-base", f"{other} / {expr.op}", Call(other, expr.args)


def _sign(expr: Call) -> Iterator[Variant]:
    yield "sign-inside", "-", expr.args[0]


def _exponential(expr: Call) -> Iterator[Variant]:
    yield "sign-inside", "exp", Call("exp", (Call("neg", expr.args),))


def _absolute(expr: Call) -> Iterator[Variant]:
    yield "absolute-forgotten", "abs", expr.args[0]


def _exchanged(*others: str) -> Callable[[Call], Iterator[Variant]]:
    def swap(expr: Call) -> Iterator[Variant]:
        for other in others:
            yield "function", f"{other} / {expr.op}", Call(other, expr.args)

    return swap


_ROTATED = {"sin": ("cos", "tan"), "cos": ("sin",), "tan": ("sin",)}

_LOCAL: dict[str, Callable[[Call], Iterator[Variant]]] = {
    "add": _sum,
    "sub": _difference,
    "mul": _product,
    "div": _quotient,
    "pow": _power,
    "sqrt": _root,
    "sin": _trigonometry,
    "cos": _trigonometry,
    "tan": _trigonometry,
    "asin": _inverse_trigonometry,
    "acos": _inverse_trigonometry,
    "atan": _inverse_trigonometry,
    "atan2": _inverse_trigonometry,
    "ln": _logarithm,
    "log2": _logarithm,
    "log10": _logarithm,
    "neg": _sign,
    "exp": _exponential,
    "abs": _absolute,
    "min": _exchanged("max"),
    "max": _exchanged("min"),
    "floor": _exchanged("ceil", "round"),
    "ceil": _exchanged("floor", "round"),
    "round": _exchanged("floor", "ceil"),
}
