"""Flashcards of a bank: whether its files can be read, and what is on them can be printed."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.bank.bank import Bank
from quizgen.bank.entries import Entry
from quizgen.bank.formulas import read_formulas
from quizgen.cards.content import KINDS as FILES
from quizgen.cards.content import read_card_entries
from quizgen.cards.kinds import KINDS
from quizgen.cards.request import DeckRequest
from quizgen.cards.versions import FILE, read_versions
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.core.errors import QuizgenError
from quizgen.question.formula_sheet import draw_sketch

DRAWN = "question"
"""The kind that is made of templates, which are examined by themselves."""


def check_cards(bank: Bank) -> Iterator[Diagnostic]:
    """Yield what is wrong with the files of ``templates/cards`` in a bank."""
    if not bank.cards:
        return
    for name, file in bank.cards.items():
        if name not in {*FILES, FILE}:
            what = f"no cards are made of this file; there are {', '.join(FILES)}"
            yield diagnose("QG504", file, what)
    read = [problem for kind in FILES.values() for problem in _check_entries(bank, kind)]
    yield from read or _check_notes(bank)
    try:
        stale = [key for key in read_versions(bank) if _has_missing_note(bank, key)]
    except QuizgenError as error:
        yield error.diagnostic(bank.folder)
        return
    for key in stale:
        yield diagnose("QG506", bank.cards[FILE], f"{key!r} is of no template", (key,))


def _check_entries(bank: Bank, kind: type[Entry]) -> Iterator[Diagnostic]:
    """Yield why the entries of a kind cannot be read, and which of their topics do not exist."""
    try:
        found = read_card_entries(bank, kind)
    except QuizgenError as error:
        yield error.diagnostic(bank.folder)
        return
    known = ", ".join(bank.topics)
    for entry in found:
        if entry.topic not in bank.topics:
            what = f"topic {entry.topic!r} is not in bank.toml ({known})"
            yield entry.fault(what, "QG129", "topic").diagnostic(bank.folder)


def _check_notes(bank: Bank) -> Iterator[Diagnostic]:
    """Yield why the notes of a kind, or the sketch of a formula, cannot be made."""
    wish = DeckRequest(bank.languages, bank=bank)
    for name, notes in KINDS.items():
        try:
            for _ in notes(wish) if name != DRAWN else ():
                pass
        except QuizgenError as error:
            yield error.diagnostic(bank.folder)
    for entry in read_formulas(bank):
        try:
            draw_sketch(bank, entry, bank.languages)
        except QuizgenError as error:
            yield error.diagnostic(bank.folder)


def _has_missing_note(bank: Bank, key: str) -> bool:
    """Return whether a listed version is of a worked question that no template makes."""
    kind, _, name = key.partition("/")
    return kind == DRAWN and name not in {bank.origin(one) for one in bank.template_paths}
