"""Formula trees back to text that reads as the same tree."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import partial

from quizgen.core.errors import FormulaError
from quizgen.maths.notation.names import FUNCTIONS, is_plain_name
from quizgen.maths.operators import OperatorSyntax, operators_with_syntax
from quizgen.maths.tree import Call, Expr, Num, Sym

EITHER, BOTH, TRUTH, RELATION, SUM, PRODUCT, POWER, ATOM = range(8)

Leaves = Mapping[str, str]
"""Name of a quantity to what is written in its place."""

_LISTS = {row.name: row.signs[0] for row in operators_with_syntax(OperatorSyntax.LIST)}
_RELATIONS = {row.name: row.signs[0] for row in operators_with_syntax(OperatorSyntax.RELATION)}


def format_tree(expr: Expr, leaves: Mapping[str, str] | None = None) -> str:
    """Return a tree in the formula grammar: ``parse_formula(format_tree(e)) == e``.

    Constants that are not plain non-negative decimals stand in braces: ``{-1/3}``.

    Parameters
    ----------
    expr : Expr
    leaves : mapping of str to str, optional
        What to write instead of a quantity's name, such as its number.

    Raises
    ------
    FormulaError
        If an operator is unknown or has an impossible number of arguments.
    """
    return _format_with_level(expr, leaves or {})[0]


def _format_with_level(expr: Expr, leaves: Leaves) -> tuple[str, int]:
    """Return a tree as text, and how tightly its outermost operator binds.

    Raises
    ------
    FormulaError
        If an operator is unknown or has an impossible number of arguments.
    """
    if isinstance(expr, Num):
        return _format_number_node(expr), ATOM
    if isinstance(expr, Sym):
        return leaves.get(expr.name) or _format_symbol_name(expr.name), ATOM
    if expr.op in FUNCTIONS or expr.op in _LISTS:
        args = ", ".join(_format_with_level(arg, leaves)[0] for arg in expr.args)
        return f"{_LISTS.get(expr.op, expr.op)}({args})", ATOM
    if expr.op in _RELATIONS and len(expr.args) == 2:
        return f" {_RELATIONS[expr.op]} ".join(
            _format_at_level(a, SUM, leaves) for a in expr.args
        ), RELATION
    writer = _WRITERS.get(expr.op)
    if writer is None:
        raise FormulaError(f"cannot write operator {expr.op!r}")
    return writer(expr, leaves)


def _format_symbol_name(name: str) -> str:
    """Return a name, in back quotes if it could not be read otherwise."""
    return name if is_plain_name(name) else f"`{name}`"


def _format_at_level(expr: Expr, level: int, leaves: Leaves) -> str:
    """Return a tree as text, in brackets if it binds less tightly than ``level``."""
    text, own = _format_with_level(expr, leaves)
    return text if own >= level else f"({text})"


def _format_number_node(num: Num) -> str:
    """Return a number, in braces if it is negative or no decimal that ends."""
    value = num.value
    if value.denominator == 1 and value >= 0:
        return f"{value.numerator}.0" if num.decimal else str(value.numerator)
    decimal = _format_terminating_decimal(abs(value))
    if num.decimal and decimal:
        return decimal if value > 0 else f"{{-{decimal}}}"
    return f"{{{value.numerator}/{value.denominator}{'.' if num.decimal else ''}}}"


def _format_terminating_decimal(value: Fraction) -> str:
    """Return a decimal of at most 40 places that ends, else an empty text."""
    for places in range(1, 41):
        scaled = value * 10**places
        if scaled.denominator == 1:
            digits = str(scaled.numerator).rjust(places + 1, "0")
            return f"{digits[:-places]}.{digits[-places:]}"
    return ""


def _format_operand_run(expr: Call, leaves: Leaves, sign: str, own: int) -> tuple[str, int]:
    """Return an n-ary sum or product; a nested one of the same kind keeps its brackets.

    Raises
    ------
    FormulaError
        If it has fewer than two arguments.
    """
    if len(expr.args) < 2:
        raise FormulaError(f"{expr.op} needs two arguments")
    first, *rest = expr.args
    same = isinstance(first, Call) and first.op == expr.op
    head = _format_at_level(first, ATOM if same else own, leaves)
    return sign.join([head, *[_format_at_level(arg, own + 1, leaves) for arg in rest]]), own


def _format_left_associative(expr: Call, leaves: Leaves, sign: str, own: int) -> tuple[str, int]:
    """Return a difference or quotient; the right side of the same kind is in brackets."""
    first, second = expr.args
    return (
        f"{_format_at_level(first, own, leaves)}{sign}{_format_at_level(second, own + 1, leaves)}",
        own,
    )


def _format_connective(expr: Call, leaves: Leaves, word: str, own: int) -> tuple[str, int]:
    """Return conditions joined by a word.

    Raises
    ------
    FormulaError
        If there are fewer than two.
    """
    if len(expr.args) < 2:
        raise FormulaError(f"{expr.op} needs two arguments")
    return f" {word} ".join(_format_at_level(arg, own + 1, leaves) for arg in expr.args), own


def _format_prefix_operator(
    expr: Call, leaves: Leaves, sign: str, inner: int, own: int
) -> tuple[str, int]:
    """Return a sign or word before its argument."""
    return f"{sign}{_format_at_level(expr.args[0], inner, leaves)}", own


def _format_power(expr: Call, leaves: Leaves) -> tuple[str, int]:
    """Return a power; towers bind from the right."""
    base, exponent = expr.args
    return (
        f"{_format_at_level(base, ATOM, leaves)}^{_format_at_level(exponent, POWER, leaves)}",
        POWER,
    )


def _format_items(expr: Call, leaves: Leaves, separator: str) -> str:
    """Return the arguments of a call one after the other; numbers need no brackets here."""
    return separator.join(
        str(arg.value) if isinstance(arg, Num) else _format_with_level(arg, leaves)[0]
        for arg in expr.args
    )


def _format_interval(expr: Call, leaves: Leaves) -> tuple[str, int]:
    """Return an interval as text and how strongly it holds together."""
    low, high, *sides = expr.args
    left, right = (isinstance(side, Num) and side.value != 0 for side in sides)
    bounds = _format_items(Call("", (low, high)), leaves, "; ")
    return f"{'[' if left else '('}{bounds}{']' if right else ')'}", ATOM


def _format_complex(expr: Call, leaves: Leaves) -> tuple[str, int]:
    """Return a complex number, ``a + b*i``, and how strongly it holds together."""
    real, imaginary = expr.args
    minus = isinstance(imaginary, Call) and imaginary.op == "neg"
    if isinstance(imaginary, Num) and imaginary.value < 0:
        minus, imaginary = True, Num(-imaginary.value, imaginary.decimal)
    elif isinstance(imaginary, Call) and minus:
        imaginary = imaginary.args[0]
    size = _format_at_level(imaginary, PRODUCT, leaves)
    unit = "i" if size == "1" else f"{size}*i"
    if isinstance(real, Num) and not real.value:
        return (f"-{unit}" if minus else unit), PRODUCT
    return f"{_format_at_level(real, SUM, leaves)} {'-' if minus else '+'} {unit}", SUM


_WRITERS: dict[str, Callable[[Call, Leaves], tuple[str, int]]] = {
    "add": partial(_format_operand_run, sign=" + ", own=SUM),
    "sub": partial(_format_left_associative, sign=" - ", own=SUM),
    "mul": partial(_format_operand_run, sign="*", own=PRODUCT),
    "div": partial(_format_left_associative, sign="/", own=PRODUCT),
    "neg": partial(_format_prefix_operator, sign="-", inner=PRODUCT, own=SUM),
    "pow": _format_power,
    "pi": lambda _expr, _leaves: ("pi", ATOM),
    "or": partial(_format_connective, word="or", own=EITHER),
    "and": partial(_format_connective, word="and", own=BOTH),
    "not": partial(_format_prefix_operator, sign="not ", inner=TRUTH, own=TRUTH),
    "row": lambda expr, leaves: (_format_items(expr, leaves, ", "), ATOM),
    "matrix": lambda expr, leaves: (f"[{_format_items(expr, leaves, '; ')}]", ATOM),
    "vector": lambda expr, leaves: (f"({_format_items(expr, leaves, '; ')})", ATOM),
    "set": lambda expr, leaves: (f"{{{_format_items(expr, leaves, '; ')}}}", ATOM),
    "union": lambda expr, leaves: (_format_items(expr, leaves, " or ") or "{}", ATOM),
    "interval": _format_interval,
    "complex": _format_complex,
    "infinity": lambda _expr, _leaves: ("inf", ATOM),
}
