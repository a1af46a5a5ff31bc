"""The formulas of a bank: each written once, for cards, the formula sheet and whatever comes next.

They stand in ``templates/cards/formulas.toml``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Literal

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.entries import Entry, Passage, read_entries
from quizgen.maths.notation import parse_formula
from quizgen.maths.tree import Call, Expr, Sym, names_in, substitute, walk_tree

NAME = "formulas"
"""The file without its suffix."""

MovingName = Literal[
    "aperture-ring", "clamped-histogram", "distortion-grid", "eye-and-filter",
    "focus-distance", "gaussian-tails", "hsv-sliders", "pinhole-point",
]  # fmt: skip
"""The figures that move which the pages have: see ``quizgen.web.moving``."""

Piece = Mapping[str, str | tuple[str, ...]]
"""What the grammar of formulas does not have, described: see ``question.formula_lines``."""

_SIGN = re.compile(r"\s(!=|<=|>=|[=<>≠≤≥∝≈→∈~≪≫⇒])\s")
_ANYWHERE = frozenset({"add", "sub", "neg", "div"})
"""Operators of means and shares, which many a step is without being a formula of the sheet."""


class FormulaSketch(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A figure of the bank that shows what a formula is about."""

    name: str
    values: dict[str, float] = {}


class FormulaEntry(Entry, frozen=True, kw_only=True):
    """A formula: its lines, what the letters mean, where it fails.

    ``units`` has the letters of each unit, ``holds`` says for which values the formula is true, and
    ``limits`` what happens at their edge; a formula that always holds has neither. ``figure`` is
    drawn beside it on the formula sheet; ``moves`` is the figure that moves of the pages, beside
    it and in the solution of questions that cover it.
    """

    title: Passage
    figure: FormulaSketch | None = None
    moves: MovingName | None = None
    lines: tuple[str, ...]
    inside: dict[str, Piece] = msgspec.field(name="with", default={})
    separate: bool = False
    about: Passage
    beware: Passage
    units: dict[str, tuple[str, ...]] = msgspec.field(default_factory=dict)
    holds: Passage = msgspec.field(default_factory=dict)
    limits: Passage = msgspec.field(default_factory=dict)


def read_formulas(bank: Bank) -> tuple[FormulaEntry, ...]:
    """Return all formulas in their order; none if the bank has no such file."""
    return read_entries(bank, NAME, FormulaEntry)


def find_missing_formulas(bank: Bank, name: str) -> list[str]:
    """Return the formulas that a template's solver applies and the bank does not have."""
    named = bank.template(name).chain.formulas.values()
    known = {entry.id for entry in read_formulas(bank)}
    return sorted({*named} - known)


def find_unnamed_formulas(bank: Bank, name: str) -> dict[str, list[str]]:
    """Return the steps of a template's solver that look like a formula and name none."""
    chain = bank.template(name).chain
    steps = {
        step.name: _erase_letters(step.expr)
        for step in chain.steps
        if step.name not in chain.formulas
    }
    known = _index_canonical_forms(bank) if steps else {}
    return {step: known[form] for step, form in steps.items() if form in known}


@cache
def _index_canonical_forms(bank: Bank) -> dict[Expr, list[str]]:
    """Return the formulas that have a form, by each form that is rare enough."""
    found = dict[Expr, set[str]]()
    for entry in read_formulas(bank):
        for expr in filter(_is_rare_form, _iter_right_sides(entry)):
            found.setdefault(_erase_letters(expr), set()).add(entry.id)
    return {form: sorted(ids) for form, ids in found.items()}


def _iter_right_sides(entry: FormulaEntry) -> Iterator[Expr]:
    """Yield the sides that a formula is computed by: all but the first.

    Pieces outside the grammar are left out.
    """
    for line in entry.lines:
        for text in split_relations(line)[1][1:]:
            expr = _parsed(text)
            if not names_in(expr) & entry.inside.keys():
                yield expr


def _is_rare_form(expr: Expr) -> bool:
    """Return whether a form is rare enough to be recognised by."""
    calls = [node.op for node in walk_tree(expr) if isinstance(node, Call)]
    return len(calls) > 1 and not _ANYWHERE.issuperset(calls)


def _erase_letters(expr: Expr) -> Expr:
    """Return a formula with its letters erased, so that spelling does not matter."""
    return substitute(expr, dict.fromkeys(names_in(expr), Sym("")))


_parsed = cache(parse_formula)


def split_relations(line: str) -> tuple[list[str], list[str]]:
    """Return the relation signs of a line, and the sides between them: one more."""
    cuts = [found for found in _SIGN.finditer(line) if _is_outside_brackets(line[: found.start()])]
    starts, ends = [0, *(one.end() for one in cuts)], [*(one.start() for one in cuts), len(line)]
    sides = [line[start:end] for start, end in zip(starts, ends, strict=True)]
    return [found[1] for found in cuts], sides


def _is_outside_brackets(before: str) -> bool:
    """Return whether a position is outside all brackets."""
    return before.count("(") == before.count(")")


def templates_by_formula(bank: Bank) -> dict[str, tuple[str, ...]]:
    """Return the templates that cover each formula, by its id."""
    found: dict[str, tuple[str, ...]] = {entry.id: () for entry in read_formulas(bank)}
    for name in bank.template_paths:
        for item in dict.fromkeys(bank.rules(name).covers):
            if item in found:
                found[item] += (name,)
    return found
