"""The authored content of a bank's deck: what its files hold.

Sentences are Markdown as in templates, in every language of the bank. Mathematics between dollar
signs and formula lines are written in the grammar that students type.
"""

from __future__ import annotations

from typing import TypeVar

import msgspec

from quizgen.bank.entries import Entry, Passage, authored
from quizgen.bank.folder import Bank
from quizgen.bank.formulas import NAME, FormulaEntry
from quizgen.locale import table


class Term(Entry, frozen=True, kw_only=True):
    """A word to know."""

    number: int
    group: str
    term: Passage
    meaning: Passage


class Trap(Entry, frozen=True, kw_only=True):
    """A wrong claim or calculation, and the right one."""

    claim: Passage
    right: Passage


class Cheat(Entry, frozen=True, kw_only=True):
    """One entry of the cheat sheet."""

    ask: Passage
    answer: Passage


class Statement(Entry, frozen=True, kw_only=True):
    """A true or a false statement, and why."""

    text: Passage
    true: bool
    why: Passage


class FigureEntry(Entry, frozen=True, kw_only=True):
    """A picture to name."""

    figure: str
    values: dict[str, float] = msgspec.field(default_factory=dict)
    quiz: bool = True
    ask: Passage
    answer: Passage


KINDS: dict[str, type[Entry]] = {
    "vocabulary": Term,
    NAME: FormulaEntry,
    "traps": Trap,
    "cheat": Cheat,
    "statements": Statement,
    "figures": FigureEntry,
}
"""Content file to what its entries are."""

E = TypeVar("E", bound=Entry)


def entries(bank: Bank, kind: type[E]) -> tuple[E, ...]:
    """Entries of one kind, read once; none if the bank has no such file.

    Raises
    ------
    BankError
        Naming file, entry and key.
    """
    (name,) = (name for name, entry in KINDS.items() if entry is kind)
    return authored(bank, name, kind)


def words(lang: str) -> dict[str, str]:
    """Short words on the cards, such as *What is wrong here?*, in one language."""
    return table(lang, "cards")
