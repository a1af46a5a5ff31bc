"""The formulas to choose from: those of misconceptions, and slips of about the right one's length.

Where the right formula is longer, or shorter, than those of all its mistakes, its length would tell
it. Most times one of them then gives way to the right formula with a slip in it.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from quizgen.bank.sampler import pick_index, shuffle
from quizgen.bank.variant import Variant
from quizgen.maths.chain import ChainStep
from quizgen.maths.tree import Call, Expr, Num
from quizgen.question.interpolation import inlines_to_text
from quizgen.question.levels.steps import (
    FormulaOption,
    applicable_branch,
    evaluate_formula,
    flatten_sums,
    is_same_value,
    leaks_answer,
    level_seed,
    right_option,
    step_formula,
    wrong_options,
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


def draw_formula_options(
    drawn: Variant, step: ChainStep, known: frozenset[str]
) -> list[FormulaOption]:
    """Return the right formula and up to three wrong ones, in a drawn order.

    The step has at least one wrong formula. Letters not in ``known`` are printed as numbers. A
    slip may replace the last, so that its length does not tell which one is right.
    """
    ways = [right_option(drawn, step, known), *wrong_options(drawn, step, known)[: WAYS - 1]]
    key = f"{level_seed(drawn)}/{step.name}"
    side = _compare_first_length(ways)
    if side and pick_index(f"{key}/length", KEPT):
        slip = next(_iter_distinct_slip_formulas(drawn, step, known, ways, side), None)
        ways = [*ways[: WAYS - 1], slip] if slip else ways
    return shuffle(f"{key}/order", ways)


def _compare_first_length(ways: list[FormulaOption]) -> int:
    """Return 1 if the first option is the longest, -1 if it is the shortest, else 0."""
    right, *others = map(_measure_formula, ways)
    return (right > max(others)) - (right < min(others))


def _measure_formula(way: FormulaOption) -> int:
    """Return the length of a formula in characters of plain text."""
    return len(inlines_to_text((way.shown,)))


def _iter_distinct_slip_formulas(
    drawn: Variant, step: ChainStep, known: frozenset[str], ways: list[FormulaOption], side: int
) -> Iterator[FormulaOption]:
    """Yield slips at least as long (or as short) as the right formula, with new values."""
    expr = flatten_sums(applicable_branch(drawn, step.expr))
    slips = list(dict.fromkeys(_iter_slip_formulas(expr)))
    for name, wrong in shuffle(f"{level_seed(drawn)}/{step.name}/slips", slips):
        value = evaluate_formula(drawn, wrong)
        if value is None or any(is_same_value(value, way.value) for way in ways):
            continue
        way = FormulaOption("", step_formula(drawn, step, wrong, known), value, name)
        if side * (_measure_formula(way) - _measure_formula(ways[0])) >= 0 and not leaks_answer(
            drawn, step.name, wrong
        ):
            yield way


def _iter_slip_formulas(expr: Expr) -> Iterator[tuple[str, Expr]]:
    """Yield the formula with one slip, and what kind of slip it is."""
    yield from _iter_operator_slips(expr)
    if isinstance(expr, Call) and expr.op not in _RAISED:
        yield "doubled", Call("mul", (Num(Fraction(2)), expr))
        yield "squared", Call("pow", (expr, Num(Fraction(2))))


def _iter_operator_slips(expr: Expr) -> Iterator[tuple[str, Expr]]:
    """Yield slips in one operator of a formula; exponents stay as they are."""
    if not isinstance(expr, Call):
        return
    first, *rest = expr.args or (expr,)
    if rest and expr.op in _TURNED:
        yield _TURNED[expr.op], Call(expr.op, (*rest, first))
    if rest and expr.op in _OTHER:
        op, name = _OTHER[expr.op]
        yield name, _group_operands(op, expr.args)
    if rest and expr.op in {"mul", "div"}:
        yield "missing", first if len(rest) == 1 else Call(expr.op, expr.args[:-1])
    for place, arg in enumerate(expr.args[: 1 if expr.op == "pow" else None]):
        for name, slip in _iter_operator_slips(arg):
            yield name, Call(expr.op, (*expr.args[:place], slip, *expr.args[place + 1 :]))


def _group_operands(op: str, args: tuple[Expr, ...]) -> Expr:
    """Return an operator between the last argument and the others."""
    if op in {"sub", "div"} and len(args) > 2:
        inner = "add" if op == "sub" else "mul"
        return Call(op, (Call(inner, args[:-1]), args[-1]))
    return Call(op, args)
