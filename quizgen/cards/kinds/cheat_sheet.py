"""The cheat sheet, entry by entry."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.cards.content import CheatSheetEntry, read_card_entries
from quizgen.cards.kinds._entry_note import entry_note
from quizgen.cards.note import Note
from quizgen.cards.request import DeckRequest
from quizgen.question.entry_prose import entry_blocks


def notes(wish: DeckRequest) -> Iterator[Note]:
    """Yield one note per entry of the cheat sheet."""
    for entry in read_card_entries(wish.bank, CheatSheetEntry):
        sides = {
            "Front": {lang: entry_blocks(entry, "ask", lang) for lang in wish.langs},
            "Back": {lang: entry_blocks(entry, "answer", lang) for lang in wish.langs},
        }
        yield entry_note(wish, entry, "cheat", sides, entry.refs)
