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
from quizgen.bank.draw import Draw
from quizgen.bank.prose import Inline, Words, fill
from quizgen.maths.chain import ChainStep
from quizgen.maths.notation import people, to_text
from quizgen.maths.numbers import exact_text, rounded_text, short_decimal
from quizgen.maths.precision import working_precision
from quizgen.maths.systems import exact, taken_branch
from quizgen.maths.tree import Expr, Sym, names
from quizgen.maths.units import shown as unit_shown
from quizgen.question.authored import printed
from quizgen.question.filling import quantity_text, with_unit
from quizgen.question.shown import Maths, named

FORMULA, NUMBERS, RESULT = "formula", "numbers", "result"


class Side(NamedTuple):
    """One side of a worked line.

    The sign before it, its layout, how it would be typed, and what it is: the formula, the formula
    with numbers, or the result.
    """

    sign: str
    node: typeset.Node
    typed: str
    role: str


def thing(drawn: Draw, name: str, lang: str) -> tuple[Inline, ...]:
    """A quantity in a sentence: what it is called, and its letter."""
    said = fill(drawn.template.quantities.name(name, lang), printed)
    return (*said, Words(" ("), named(name), Words(")")) if said else (named(name),)


def worked(drawn: Draw, step: ChainStep) -> Maths:
    """One step, printed from formula to rounded value.

    Parameters
    ----------
    drawn : Draw
    step : ChainStep
    """
    return in_line(step.name, sides_of(drawn, step))


@lru_cache(maxsize=128)
def sides_of(drawn: Draw, step: ChainStep) -> tuple[Side, ...]:
    """The sides of a worked step, from formula to rounded value, the same in every language."""
    with working_precision():
        expr = taken_branch(step.expr, drawn.values, exact())
    sides = [Side("=", typeset.layout(expr), to_text(expr), FORMULA)]
    if names(expr):
        sides.append(_with_numbers(drawn, expr))
    values = _values(drawn, step, about=sides[-1].sign == "≈")
    sides += [side for side in values if side.typed != sides[-1].typed]
    return tuple(sides)


def in_line(name: str, sides: Sequence[Side]) -> Maths:
    """A quantity and some of its sides, one behind another."""
    signs = [side.sign for side in sides]
    nodes = [typeset.name(name), *(side.node for side in sides)]
    typed = "".join(f" {side.sign} {side.typed}" for side in sides)
    return Maths(typeset.relation(signs, nodes), f"{name}{typed}")


def _with_numbers(drawn: Draw, expr: Expr) -> Side:
    """The formula with numbers in place; equal unless one of them is shown rounded."""
    quantities = sorted(names(expr))
    sign = "≈" if any(drawn.is_rounded(name) for name in quantities) else "="
    node = typeset.layout(expr, leaves={name: drawn_node(drawn, name) for name in quantities})
    if isinstance(expr, Sym):
        return Side(sign, node, quantity_text(drawn, expr.name), NUMBERS)
    return Side(
        sign, node, to_text(expr, {name: drawn_typed(drawn, name) for name in quantities}), NUMBERS
    )


def drawn_node(drawn: Draw, name: str) -> typeset.Node:
    """The number of a quantity with its unit, to stand in a formula."""
    return typeset.quantity(drawn.text(name), unit_shown(drawn.template.units[name]))


def drawn_typed(drawn: Draw, name: str) -> str:
    """A quantity inside a typed formula: in brackets unless it is a number alone."""
    text = quantity_text(drawn, name)
    return text if re.fullmatch(rf"[0-9.{people.GAP}]+", text) else f"({text})"


def _values(drawn: Draw, step: ChainStep, *, about: bool) -> list[Side]:
    """The exact value if it can be shown, and the rounded one if that says more.

    Behind rounded numbers (``about``) nothing is equal, and only a short exact value says more.
    """
    value, unit = drawn.shown_values[step.name], unit_shown(step.unit)
    exactly = None if about and not short_decimal(value) else exact_text(value)
    texts = [] if exactly is None else [("≈" if about else "=", exactly)]
    if not short_decimal(value):
        texts.append(("≈", rounded_text(value)))
    return [
        Side(sign, typeset.quantity(text, unit), with_unit(text, step.unit), RESULT)
        for sign, text in texts
    ]
