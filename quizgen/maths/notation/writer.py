"""Formula trees back to text that reads as the same tree."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from quizgen.errors import FormulaError
from quizgen.maths.notation.names import FUNCTIONS, plain
from quizgen.maths.tree import Call, Expr, Num, Sym

EITHER, BOTH, TRUTH, RELATION, SUM, PRODUCT, POWER, ATOM = range(8)

_RELATIONS = {"eq": "=", "ne": "!=", "lt": "<", "le": "<=", "gt": ">", "ge": ">="}


def to_text(expr: Expr) -> str:
    """Write a tree in the formula grammar; ``parse(to_text(e)) == e``.

    Constants that are not plain non-negative decimals stand in braces: ``{-1/3}``.

    Raises
    ------
    FormulaError
        If an operator is unknown or has an impossible number of arguments.
    """
    return _write(expr)[0]


def _write(expr: Expr) -> tuple[str, int]:
    if isinstance(expr, Num):
        return _number(expr), ATOM
    if isinstance(expr, Sym):
        return (expr.name if plain(expr.name) else f"`{expr.name}`"), ATOM
    if expr.op in FUNCTIONS:
        return f"{expr.op}({', '.join(to_text(arg) for arg in expr.args)})", ATOM
    if expr.op in _RELATIONS and len(expr.args) == 2:
        return f" {_RELATIONS[expr.op]} ".join(_at(a, SUM) for a in expr.args), RELATION
    writer = _WRITERS.get(expr.op)
    if writer is None:
        raise FormulaError(f"cannot write operator {expr.op!r}")
    return writer(expr)


def _at(expr: Expr, level: int) -> str:
    text, own = _write(expr)
    return text if own >= level else f"({text})"


def _number(num: Num) -> str:
    value = num.value
    if value.denominator == 1 and value >= 0:
        return f"{value.numerator}.0" if num.decimal else str(value.numerator)
    decimal = _decimal(abs(value))
    if num.decimal and decimal:
        return decimal if value > 0 else f"{{-{decimal}}}"
    return f"{{{value.numerator}/{value.denominator}{'.' if num.decimal else ''}}}"


def _decimal(value: Fraction) -> str:
    """Terminating decimal, or an empty text."""
    for places in range(1, 41):
        scaled = value * 10**places
        if scaled.denominator == 1:
            digits = str(scaled.numerator).rjust(places + 1, "0")
            return f"{digits[:-places]}.{digits[-places:]}"
    return ""


def _run(expr: Call, sign: str, own: int) -> tuple[str, int]:
    """Write an n-ary sum or product; a nested one of the same kind keeps its brackets."""
    if len(expr.args) < 2:
        raise FormulaError(f"{expr.op} needs two arguments")
    first, *rest = expr.args
    same = isinstance(first, Call) and first.op == expr.op
    head = f"({to_text(first)})" if same else _at(first, own)
    return sign.join([head, *[_at(arg, own + 1) for arg in rest]]), own


def _left(expr: Call, sign: str, own: int) -> tuple[str, int]:
    first, second = expr.args
    return f"{_at(first, own)}{sign}{_at(second, own + 1)}", own


def _joined(expr: Call, word: str, own: int) -> tuple[str, int]:
    if len(expr.args) < 2:
        raise FormulaError(f"{expr.op} needs two arguments")
    return f" {word} ".join(_at(arg, own + 1) for arg in expr.args), own


_WRITERS: dict[str, Callable[[Call], tuple[str, int]]] = {
    "add": lambda e: _run(e, " + ", SUM),
    "sub": lambda e: _left(e, " - ", SUM),
    "mul": lambda e: _run(e, "*", PRODUCT),
    "div": lambda e: _left(e, "/", PRODUCT),
    "neg": lambda e: (f"-{_at(e.args[0], PRODUCT)}", SUM),
    "pow": lambda e: (f"{_at(e.args[0], ATOM)}^{_at(e.args[1], POWER)}", POWER),
    "pi": lambda _e: ("pi", ATOM),
    "or": lambda e: _joined(e, "or", EITHER),
    "and": lambda e: _joined(e, "and", BOTH),
    "not": lambda e: (f"not {_at(e.args[0], TRUTH)}", TRUTH),
}
