"""One worked step: *formula = numbers in place = exact value ~ rounded value*.

All of it comes from the one chain of the solver: the formula is printed, the same formula is
printed with the drawn numbers in place, and its exact value follows.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from quizgen import typeset
from quizgen.bank.markdown import fill_inlines
from quizgen.bank.variant import Variant
from quizgen.maths.chain import ChainStep
from quizgen.maths.notation import format_tree, pretty
from quizgen.maths.number_systems import exact_system, select_branch
from quizgen.maths.numbers import (
    format_exact_in_unit,
    format_rounded,
    is_readable_exactly,
    is_short_decimal,
)
from quizgen.maths.precision import working_precision
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in
from quizgen.maths.units import format_unit
from quizgen.question.entry_prose import typeset_slot
from quizgen.question.interpolation import format_quantity, join_unit
from quizgen.question.list_steps import write_out_lists
from quizgen.typeset.prose import Inline, PlainText, TypesetMaths, name_inline

FORMULA, NUMBERS, RESULT = "formula", "numbers", "result"


_RELATIONS = frozenset({"eq", "lt", "le", "gt", "ge"})


class WorkedSide(NamedTuple):
    """One side of a worked line: formula, numbers, exact or rounded value.

    The sign before it, its layout, how it would be typed, and what it is: the formula, the formula
    with numbers, or the result.
    """

    sign: str
    node: typeset.Node
    typed: str
    role: str


def quantity_inlines(drawn: Variant, name: str, lang: str) -> tuple[Inline, ...]:
    """Return a quantity for a sentence: what it is called, and its letter."""
    said = fill_inlines(drawn.template.quantities.name(name, lang), typeset_slot)
    return (
        (*said, PlainText(" ("), name_inline(name), PlainText(")"))
        if said
        else (name_inline(name),)
    )


def typeset_step(drawn: Variant, step: ChainStep) -> TypesetMaths:
    """Return one step, typeset from formula to rounded value.

    Parameters
    ----------
    drawn : Variant
    step : ChainStep
    """
    return join_sides(step.name, step_sides(drawn, step))


@lru_cache(maxsize=128)
def step_sides(drawn: Variant, step: ChainStep) -> tuple[WorkedSide, ...]:
    """Return the sides of a worked step, from formula to rounded value, for any language."""
    with working_precision():
        expr = select_branch(step.expr, drawn.values, exact_system())
    sides = [WorkedSide("=", typeset.lay_out(expr), format_tree(expr), FORMULA)]
    if names_in(expr):
        sides.append(_substitute_numbers(drawn, expr))
    values = _build_value_sides(drawn, step, about=sides[-1].sign == "≈")
    if values and isinstance(expr, Sym):  # the number put in is the value already
        return (sides[0], *values)
    sides += [side for side in values if side.typed != sides[-1].typed]
    return tuple(sides)


def form_sides(drawn: Variant, step: ChainStep) -> tuple[WorkedSide, ...]:
    """Return the sides of a form: its formula, and the same with numbers in place, tidied."""
    with working_precision():
        expr = select_branch(step.expr, drawn.values, exact_system())
    states = isinstance(expr, Call) and expr.op in _RELATIONS  # a name is no side of an equation
    first, then = (":", "⇔") if states else ("=", "=")
    sides = [WorkedSide(first, typeset.lay_out(expr), format_tree(expr), FORMULA)]
    bound = drawn.form(step.name)
    if bound != expr:
        sides.append(WorkedSide(then, typeset.lay_out(bound), format_tree(bound), RESULT))
    return tuple(sides)


def join_sides(name: str, sides: Sequence[WorkedSide]) -> TypesetMaths:
    """Return a quantity and some of its sides as one worked line."""
    signs = [side.sign for side in sides]
    nodes = [typeset.lay_out_name(name), *(side.node for side in sides)]
    typed = "".join(f" {side.sign} {side.typed}".replace(" :", ":", 1) for side in sides)
    return TypesetMaths(typeset.relation_chain(signs, nodes), f"{name}{typed}")


def _substitute_numbers(drawn: Variant, expr: Expr) -> WorkedSide:
    """Return the formula with numbers in place; equal unless one of them is shown rounded."""
    if names_in(expr) & drawn.lists.keys():
        return _with_list_values(drawn, expr)
    quantities = sorted(names_in(expr))
    sign = "≈" if any(drawn.is_cut(name) for name in quantities) else "="
    if _adds_plain_degrees(drawn, expr, quantities):
        bare = {name: drawn.format_value(name) for name in quantities}
        node = typeset.lay_out(
            expr, leaves={name: typeset.quantity(text, "") for name, text in bare.items()}
        )
        return WorkedSide(sign, node, format_tree(expr, bare), NUMBERS)
    node = typeset.lay_out(expr, leaves={name: value_node(drawn, name) for name in quantities})
    if isinstance(expr, Sym):
        return WorkedSide(sign, node, format_quantity(drawn, expr.name), NUMBERS)
    return WorkedSide(
        sign,
        node,
        format_tree(expr, {name: value_typed(drawn, name) for name in quantities}),
        NUMBERS,
    )


def _adds_plain_degrees(drawn: Variant, expr: Expr, quantities: Sequence[str]) -> bool:
    """Whether a sum mixes angles with plain numbers of degrees: no sign of degrees then."""
    return (
        isinstance(expr, Call)
        and expr.op in {"add", "sub"}
        and any(isinstance(one, Num) for one in expr.args)
        and all(drawn.template.units[name] == "deg" for name in quantities)
    )


def _with_list_values(drawn: Variant, expr: Expr) -> WorkedSide:
    """Return the formula with sums over lists written out, and other lists as they stand."""
    written = write_out_lists(expr, drawn)
    scalars = names_in(written.expr) - written.texts.keys()
    rounded = written.rounded or any(drawn.is_cut(name) for name in scalars)
    nodes = {name: value_node(drawn, name) for name in scalars} | written.nodes
    typed = {name: value_typed(drawn, name) for name in scalars} | written.texts
    node = typeset.lay_out(written.expr, leaves=nodes)
    return WorkedSide("≈" if rounded else "=", node, format_tree(written.expr, typed), NUMBERS)


def value_node(drawn: Variant, name: str) -> typeset.Node:
    """Return the number of a quantity with its unit, to stand in a formula."""
    return typeset.quantity(drawn.format_value(name), format_unit(drawn.template.units[name]))


def value_typed(drawn: Variant, name: str) -> str:
    """Return a quantity for a typed formula: in brackets unless it is a number alone."""
    text = format_quantity(drawn, name)
    return text if re.fullmatch(rf"[0-9.{pretty.GAP}]+", text) else f"({text})"


WHOLE = frozenset({"ceil", "floor", "round"})


def _build_value_sides(drawn: Variant, step: ChainStep, *, about: bool) -> list[WorkedSide]:
    """Return the exact value if it can be shown, and the rounded one if that says more.

    Behind rounded numbers (``about``) nothing is equal, and only a short exact value says more;
    but whole numbers are what they are. A fraction is shown if it is read at a glance, or leads to
    an answer that must be exact.
    """
    value = drawn.shown_values[step.name]
    about = about and not (isinstance(step.expr, Call) and step.expr.op in WHOLE)
    is_short = is_short_decimal(value)
    if is_short and drawn.is_rounded(step.name):
        return [_result_side("≈", format_rounded(value), step.unit)]
    is_told = is_readable_exactly(value) or step.name in drawn.template.exact_steps
    exactly = None
    if is_told and not (about and not is_short):
        exactly = format_exact_in_unit(value, step.unit)
    texts = [] if exactly is None else [("≈" if about else "=", exactly)]
    if not is_short:
        texts.append(("≈", format_rounded(value)))
    return [_result_side(sign, text, step.unit) for sign, text in texts]


def _result_side(sign: str, text: str, unit: str) -> WorkedSide:
    """Return a value as the last side of a step."""
    return WorkedSide(
        sign, typeset.quantity(text, format_unit(unit)), join_unit(text, unit), RESULT
    )
