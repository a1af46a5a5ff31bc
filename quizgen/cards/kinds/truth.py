"""True or false, and why."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.cards.content import StatementEntry, load_card_words, read_card_entries
from quizgen.cards.kinds._entry_note import entry_note
from quizgen.cards.markup import CardLabel
from quizgen.cards.note import CardBlocks, Note
from quizgen.cards.request import DeckRequest
from quizgen.question.entry_prose import entry_blocks
from quizgen.typeset.prose import Emphasis, Paragraph, PlainText


def notes(wish: DeckRequest) -> Iterator[Note]:
    """Yield one note per true or false statement."""
    for entry in read_card_entries(wish.bank, StatementEntry):
        sides = {
            "Front": {
                lang: (
                    CardLabel(load_card_words(lang)["truth"]),
                    *entry_blocks(entry, "text", lang),
                )
                for lang in wish.langs
            },
            "Back": {lang: _build_verdict_blocks(entry, lang) for lang in wish.langs},
        }
        yield entry_note(wish, entry, "truth", sides, entry.refs)


def _build_verdict_blocks(entry: StatementEntry, lang: str) -> CardBlocks:
    """Return whether a statement is true, and why."""
    verdict = PlainText(load_card_words(lang)["true" if entry.true else "false"])
    return Paragraph((Emphasis("strong", (verdict,)),)), *entry_blocks(entry, "why", lang)
