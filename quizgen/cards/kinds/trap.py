"""Traps: a wrong claim on the front, what is wrong and the right way on the back."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.cards.content import TrapEntry, load_card_words, read_card_entries
from quizgen.cards.kinds._entry_note import entry_note
from quizgen.cards.markup import CardLabel
from quizgen.cards.note import CardWords, Note
from quizgen.cards.request import DeckRequest
from quizgen.question.entry_prose import entry_blocks


def notes(wish: DeckRequest) -> Iterator[Note]:
    """Yield one note per wrong claim of the bank's traps."""
    for entry in read_card_entries(wish.bank, TrapEntry):
        sides: dict[str, CardWords] = {
            "Front": {
                lang: (
                    CardLabel(load_card_words(lang)["wrong"]),
                    *entry_blocks(entry, "claim", lang),
                )
                for lang in wish.langs
            },
            "Back": {lang: entry_blocks(entry, "right", lang) for lang in wish.langs},
        }
        yield entry_note(wish, entry, "trap", sides, (entry.id, *entry.refs))
