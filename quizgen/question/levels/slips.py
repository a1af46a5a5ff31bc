"""The formulas to choose from: those of known mistakes, and slips of about the right one's length.

Where the right formula is longer, or shorter, than those of all its mistakes, its length would tell
it. Most times one of them then gives way to the right formula with a slip in it.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from quizgen.bank.draw import Draw
from quizgen.bank.plan import pick, shuffled
from quizgen.maths.chain import ChainStep
from quizgen.maths.tree import Call, Expr, Num
from quizgen.question.filling import plain
from quizgen.question.levels.steps import (
    Way,
    branch,
    flat,
    formula,
    key_of,
    right_way,
    same_value,
    tells,
    value_of,
    wrong_ways,
)

WAYS = 4
"""Formulas to choose from."""
KEPT = 4
"""Of so many formulas that their length tells, one is left so: slips are no sign of it either."""
_TURNED = {"div": "upside-down", "sub": "turned", "mod": "places"}
"""Operators whose two places may be mixed up, and the slip's name."""
_OTHER = {
    "sub": ("add", "sum"),
    "add": ("sub", "difference"),
    "mul": ("div", "divided"),
    "div": ("mul", "multiplied"),
    "max": ("min", "smallest"),
    "min": ("max", "largest"),
}
"""Operators that may be taken for another one."""
_RAISED = frozenset({"pow", "sqrt", "root"})


def offered(drawn: Draw, step: ChainStep, known: frozenset[str]) -> list[Way]:
    """The formulas to choose from, in a drawn order."""
    ways = [right_way(drawn, step, known), *wrong_ways(drawn, step, known)[: WAYS - 1]]
    key = f"{key_of(drawn)}/{step.name}"
    side = _side(ways)
    if side and pick(f"{key}/length", KEPT):
        slip = next(_slipped(drawn, step, known, ways, side), None)
        ways = [*ways[: WAYS - 1], slip] if slip else ways
    return shuffled(f"{key}/order", ways)


def _side(ways: list[Way]) -> int:
    """1 where the first is the longest, -1 where it is the shortest, 0 where neither."""
    right, *others = map(_length, ways)
    return (right > max(others)) - (right < min(others))


def _length(way: Way) -> int:
    return len(plain((way.shown,)))


def _slipped(
    drawn: Draw, step: ChainStep, known: frozenset[str], ways: list[Way], side: int
) -> Iterator[Way]:
    """Slips at least as long (or as short) as the right formula, with values that none has."""
    expr = flat(branch(drawn, step.expr))
    slips = list(dict.fromkeys(_slips(expr)))
    for name, wrong in shuffled(f"{key_of(drawn)}/{step.name}/slips", slips):
        value = value_of(drawn, wrong)
        if value is None or any(same_value(value, way.value) for way in ways):
            continue
        way = Way("", formula(drawn, step, wrong, known), value, name)
        if side * (_length(way) - _length(ways[0])) >= 0 and not tells(drawn, step.name, wrong):
            yield way


def _slips(expr: Expr) -> Iterator[tuple[str, Expr]]:
    """The formula with one slip, and what kind of slip it is."""
    yield from _within(expr)
    if isinstance(expr, Call) and expr.op not in _RAISED:
        yield "doubled", Call("mul", (Num(Fraction(2)), expr))
        yield "squared", Call("pow", (expr, Num(Fraction(2))))


def _within(expr: Expr) -> Iterator[tuple[str, Expr]]:
    """Slips in one operator of a formula; exponents stay as they are."""
    if not isinstance(expr, Call):
        return
    first, *rest = expr.args or (expr,)
    if rest and expr.op in _TURNED:
        yield _TURNED[expr.op], Call(expr.op, (*rest, first))
    if rest and expr.op in _OTHER:
        op, name = _OTHER[expr.op]
        yield name, _paired(op, expr.args)
    if rest and expr.op in {"mul", "div"}:
        yield "missing", first if len(rest) == 1 else Call(expr.op, expr.args[:-1])
    for place, arg in enumerate(expr.args[: 1 if expr.op == "pow" else None]):
        for name, slip in _within(arg):
            yield name, Call(expr.op, (*expr.args[:place], slip, *expr.args[place + 1 :]))


def _paired(op: str, args: tuple[Expr, ...]) -> Expr:
    """An operator between the last argument and the others."""
    if op in {"sub", "div"} and len(args) > 2:
        inner = "add" if op == "sub" else "mul"
        return Call(op, (Call(inner, args[:-1]), args[-1]))
    return Call(op, args)
