"""Generic slips as small changes of a formula: the wrong formulas that a slip would compute."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction

from quizgen.maths.tree import Call, Expr, Num, Sym

Mutation = tuple[str, str, Expr]
"""Note, the name or operator concerned, and the changed formula."""

TWO = Num(Fraction(2))
HALF_TURN = Num(Fraction(180))
PI = Call("pi", ())


def mutate_formula(expr: Expr, alike: Mapping[str, list[str]]) -> Iterator[Mutation]:
    """Yield every formula that differs from the right one by one slip.

    Parameters
    ----------
    expr : Expr
        The right formula.
    alike : mapping of str to list of str
        Quantity name to other given quantities of the same dimension.
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
        for note, detail, changed in mutate_formula(arg, alike):
            yield note, detail, _replace_argument(expr, position, changed)


def _replace_argument(expr: Call, position: int, arg: Expr) -> Call:
    """Return a call with another argument at a position."""
    return Call(expr.op, (*expr.args[:position], arg, *expr.args[position + 1 :]))


def _drop_argument(expr: Call, position: int) -> Expr:
    """Return a call without one argument; what is left, if that is a single one."""
    rest = (*expr.args[:position], *expr.args[position + 1 :])
    return rest[0] if len(rest) == 1 else Call(expr.op, rest)


def _mutate_sum(expr: Call) -> Iterator[Mutation]:
    """Yield the sum with one term left out, or with its sign turned."""
    for position, term in enumerate(expr.args):
        yield "term-left-out", "+", _drop_argument(expr, position)
        yield "operator", "+ / -", _replace_argument(expr, position, Call("neg", (term,)))


def _mutate_difference(expr: Call) -> Iterator[Mutation]:
    """Yield the sum in its stead, the terms exchanged, and each term alone."""
    first, second = expr.args
    yield "operator", "- / +", Call("add", (first, second))
    yield "operands", "-", Call("sub", (second, first))
    yield "term-left-out", "-", first
    yield "term-left-out", "-", second


def _mutate_product(expr: Call) -> Iterator[Mutation]:
    """Yield the product with one factor left out, or divided by."""
    for position, factor in enumerate(expr.args):
        rest = _drop_argument(expr, position)
        yield "factor-left-out", "*", rest
        yield "operator", "* / ÷", Call("div", (rest, factor))


def _mutate_quotient(expr: Call) -> Iterator[Mutation]:
    """Yield the quotient upside down, the product in its stead, and the numerator alone."""
    first, second = expr.args
    yield "ratio-inverted", "/", Call("div", (second, first))
    yield "operator", "÷ / *", Call("mul", (first, second))
    yield "factor-left-out", "/", first


def _mutate_power(expr: Call) -> Iterator[Mutation]:
    """Yield the base alone, the power with the reciprocal exponent, and base times exponent."""
    base, exponent = expr.args
    note = "square-forgotten" if exponent == TWO else "exponent-forgotten"
    yield note, "^", base
    yield "exponent-inverted", "^", Call("pow", (base, Call("div", (Num(Fraction(1)), exponent))))
    yield "exponent-as-factor", "^", Call("mul", (base, exponent))


def _mutate_root(expr: Call) -> Iterator[Mutation]:
    """Yield what stands under the root."""
    yield "root-forgotten", "sqrt", expr.args[0]


def _mutate_trigonometry(expr: Call) -> Iterator[Mutation]:
    """Yield the function of an angle in the wrong unit, and other functions of the angle."""
    (arg,) = expr.args
    for scale in (Call("div", (PI, HALF_TURN)), Call("div", (HALF_TURN, PI))):
        yield "degrees-radians", expr.op, Call(expr.op, (Call("mul", (arg, scale)),))
    for other in _ROTATED[expr.op]:
        yield "function", f"{other} / {expr.op}", Call(other, (arg,))


def _mutate_inverse_trigonometry(expr: Call) -> Iterator[Mutation]:
    """Yield the angle in degrees taken for radians, and the other way round."""
    for scale in (Call("div", (PI, HALF_TURN)), Call("div", (HALF_TURN, PI))):
        yield "degrees-radians", expr.op, Call("mul", (expr, scale))


def _mutate_logarithm(expr: Call) -> Iterator[Mutation]:
    """Yield the logarithms to the other usual bases."""
    for other in ("ln", "log2", "log10"):
        if other != expr.op:
            yield "log-base", f"{other} / {expr.op}", Call(other, expr.args)


def _mutate_negation(expr: Call) -> Iterator[Mutation]:
    """Yield the formula without its minus sign."""
    yield "sign-inside", "-", expr.args[0]


def _mutate_exponential(expr: Call) -> Iterator[Mutation]:
    """Yield the exponential function of the opposite exponent."""
    yield "sign-inside", "exp", Call("exp", (Call("neg", expr.args),))


def _mutate_absolute_value(expr: Call) -> Iterator[Mutation]:
    """Yield what stands between the bars."""
    yield "absolute-forgotten", "abs", expr.args[0]


def _make_function_swapper(*others: str) -> Callable[[Call], Iterator[Mutation]]:
    """Return a rule that yields a call with each of some other functions in its place."""

    def swap(expr: Call) -> Iterator[Mutation]:
        """Yield the call with another function."""
        for other in others:
            yield "function", f"{other} / {expr.op}", Call(other, expr.args)

    return swap


_ROTATED = {"sin": ("cos", "tan"), "cos": ("sin",), "tan": ("sin",)}

_LOCAL: dict[str, Callable[[Call], Iterator[Mutation]]] = {
    "add": _mutate_sum,
    "sub": _mutate_difference,
    "mul": _mutate_product,
    "div": _mutate_quotient,
    "pow": _mutate_power,
    "sqrt": _mutate_root,
    "sin": _mutate_trigonometry,
    "cos": _mutate_trigonometry,
    "tan": _mutate_trigonometry,
    "asin": _mutate_inverse_trigonometry,
    "acos": _mutate_inverse_trigonometry,
    "atan": _mutate_inverse_trigonometry,
    "atan2": _mutate_inverse_trigonometry,
    "ln": _mutate_logarithm,
    "log2": _mutate_logarithm,
    "log10": _mutate_logarithm,
    "neg": _mutate_negation,
    "exp": _mutate_exponential,
    "abs": _mutate_absolute_value,
    "min": _make_function_swapper("max"),
    "max": _make_function_swapper("min"),
    "floor": _make_function_swapper("ceil", "round"),
    "ceil": _make_function_swapper("floor", "round"),
    "round": _make_function_swapper("floor", "ceil"),
}
