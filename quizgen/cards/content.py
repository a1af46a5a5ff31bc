"""The authored content of a bank's deck: what its files hold.

Sentences are Markdown as in templates, in every language of the bank. Mathematics between dollar
signs and formula lines are written in the grammar that students type.
"""

from __future__ import annotations

from typing import TypeVar

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.entries import Entry, Passage, read_entries
from quizgen.bank.formulas import NAME, FormulaEntry
from quizgen.locale import load_words


class VocabularyEntry(Entry, frozen=True, kw_only=True):
    """A term to know, with its meaning."""

    number: int
    group: str
    term: Passage
    meaning: Passage


class TrapEntry(Entry, frozen=True, kw_only=True):
    """A wrong claim or calculation, with the right one."""

    claim: Passage
    right: Passage


class CheatSheetEntry(Entry, frozen=True, kw_only=True):
    """One question and answer of the cheat sheet."""

    ask: Passage
    answer: Passage


class StatementEntry(Entry, frozen=True, kw_only=True):
    """A true or a false statement, with the reason."""

    text: Passage
    true: bool
    why: Passage


class FigureEntry(Entry, frozen=True, kw_only=True):
    """A figure to name, with its question and answer."""

    figure: str
    values: dict[str, float] = msgspec.field(default_factory=dict)
    quiz: bool = True
    ask: Passage
    answer: Passage


KINDS: dict[str, type[Entry]] = {
    "vocabulary": VocabularyEntry,
    NAME: FormulaEntry,
    "traps": TrapEntry,
    "cheat": CheatSheetEntry,
    "statements": StatementEntry,
    "figures": FigureEntry,
}
"""Content file to what its entries are."""

E = TypeVar("E", bound=Entry)


def read_card_entries(bank: Bank, kind: type[E]) -> tuple[E, ...]:
    """Return a bank's entries of one kind; none if the bank has no such file.

    Raises
    ------
    BankError
        Naming file, entry and key.
    """
    (name,) = (name for name, entry in KINDS.items() if entry is kind)
    return read_entries(bank, name, kind)


def load_card_words(lang: str) -> dict[str, str]:
    """Return the short words on cards, such as *What is wrong here?*, by key, in one language."""
    return load_words(lang, "cards")
