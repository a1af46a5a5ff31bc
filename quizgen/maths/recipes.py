"""How a step follows from the forms before it, so that it can be followed from a student's own.

A chain has steps with forms worked out: the derivative of the key's formula. A recipe keeps what
was done, as a formula over *uses*: names for a form, maybe differentiated, taken at a place, or an
entry of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

import msgspec

from quizgen.core.decoding import convert
from quizgen.core.errors import MathError
from quizgen.maths.derivative import differentiate
from quizgen.maths.tree import Call, Expr, substitute

STRUCTURES = frozenset({
    "matrix", "row", "vector", "complex", "union", "interval", "set", "infinity", "piecewise",
})  # fmt: skip
"""Operators of forms that formulas are not written with."""
WrittenForm: TypeAlias = Any
"""A form as JSON: the text of a formula, or an operator of ``STRUCTURES`` before its arguments."""


class Use(msgspec.Struct, frozen=True, array_like=True):
    """What a name in a recipe stands for.

    ``of`` is a form, ``entry`` leads to one of its numbers, ``by`` are names by which it is
    differentiated, ``at`` holds what then stands for some of its names.
    """

    name: str
    of: str
    entry: tuple[int, ...] = ()
    by: tuple[str, ...] = ()
    at: tuple[tuple[str, Expr], ...] = ()

    def follow(self, forms: Mapping[str, Expr]) -> Expr:
        """Return what the name stands for with these forms; ``MathError`` if there is no such."""
        found = forms[self.of]
        for place in self.entry:
            if not isinstance(found, Call) or place >= len(found.args):
                raise MathError("a form of another size")
            found = found.args[place]
        for name in self.by:
            found = differentiate(found, name)
        return substitute(found, dict(self.at))


class Recipe(msgspec.Struct, frozen=True, array_like=True):
    """A step as a formula over given quantities, steps and ``uses`` of forms."""

    expr: Expr
    uses: tuple[Use, ...]

    def follow(self, forms: Mapping[str, Expr]) -> Expr:
        """Return the formula of the step with these forms.

        Raises
        ------
        MathError
            If a form is of another size, or has no derivative.
        """
        return substitute(self.expr, {use.name: use.follow(forms) for use in self.uses})


def encode_form(form: Expr) -> WrittenForm:
    """Return a form for JSON."""
    from quizgen.maths.notation import format_tree

    if isinstance(form, Call) and form.op in STRUCTURES:
        return [form.op, *map(encode_form, form.args)]
    return format_tree(form)


def decode_form(written: WrittenForm) -> Expr:
    """Return a form from JSON.

    Raises
    ------
    FormulaError
        If a formula in it cannot be read.
    ValueError
        If it is none.
    """
    from quizgen.maths.notation import parse_formula

    if isinstance(written, str):
        return parse_formula(written)
    if not isinstance(written, list) or not written or written[0] not in STRUCTURES:
        raise ValueError("no form of a solver")
    return Call(written[0], tuple(map(decode_form, written[1:])))


def encode_recipe(recipe: Recipe) -> list[Any]:
    """Return a recipe for JSON."""
    uses = [
        [use.name, use.of, list(use.entry), list(use.by), {n: encode_form(e) for n, e in use.at}]
        for use in recipe.uses
    ]
    return [encode_form(recipe.expr), uses]


class _WrittenUse(msgspec.Struct, array_like=True):
    """A use as JSON."""

    name: str
    of: str
    entry: list[int]
    by: list[str]
    at: dict[str, Any]


def decode_recipe(written: WrittenForm) -> Recipe:
    """Return a recipe from JSON; raises as ``decode_form``."""
    try:
        form, uses = convert(written, tuple[Any, list[_WrittenUse]])
    except msgspec.ValidationError as error:
        raise ValueError(f"no recipe of a step: {error}") from None
    if any(place < 0 for use in uses for place in use.entry):
        raise ValueError("no recipe of a step: a negative place")
    found = [
        Use(
            use.name, use.of, tuple(use.entry), tuple(use.by),
            tuple((name, decode_form(form)) for name, form in use.at.items()),
        )
        for use in uses
    ]  # fmt: skip
    return Recipe(decode_form(form), tuple(found))
