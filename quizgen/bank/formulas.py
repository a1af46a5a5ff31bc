"""The formulas of a bank: each written once, for cards, the formula sheet and whatever comes next.

They stand in ``templates/cards/formulas.toml``.
"""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from quizgen.bank.entries import Entry, Passage, authored
from quizgen.bank.folder import Bank

NAME = "formulas"
"""The file without its suffix."""

Piece = Mapping[str, str | tuple[str, ...]]
"""What the grammar of formulas does not have, described: see ``question.equations``."""


class FormulaEntry(Entry, frozen=True, kw_only=True):
    """A formula: its lines, what the letters mean, where it fails.

    ``units`` has the letters of each unit, ``holds`` says for which values the formula is true, and
    ``limits`` what happens at their edge; a formula that always holds has neither.
    """

    title: Passage
    lines: tuple[str, ...]
    inside: dict[str, Piece] = msgspec.field(name="with", default={})
    separate: bool = False
    about: Passage
    beware: Passage
    units: dict[str, tuple[str, ...]] = msgspec.field(default_factory=dict)
    holds: Passage = msgspec.field(default_factory=dict)
    limits: Passage = msgspec.field(default_factory=dict)


def formulas(bank: Bank) -> tuple[FormulaEntry, ...]:
    """All formulas in their order; none if the bank has no such file."""
    return authored(bank, NAME, FormulaEntry)


def missing_formulas(bank: Bank, name: str) -> list[str]:
    """Formulas that a template's solver says to apply, and the bank does not have."""
    named = bank.template(name).chain.formulas.values()
    known = {entry.id for entry in formulas(bank)}
    return sorted({*named} - known)


def asked_in(bank: Bank) -> dict[str, tuple[str, ...]]:
    """The templates that cover each formula, by its id."""
    found: dict[str, tuple[str, ...]] = {entry.id: () for entry in formulas(bank)}
    for name in bank.paths:
        for item in dict.fromkeys(bank.rules(name).covers):
            if item in found:
                found[item] += (name,)
    return found
