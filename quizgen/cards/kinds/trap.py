"""Traps: a wrong claim on the front, what is wrong and the right way on the back."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.cards.content import Trap, entries, passage, words
from quizgen.cards.note import Note
from quizgen.cards.prose import Label
from quizgen.cards.wish import Wish


def notes(wish: Wish) -> Iterator[Note]:
    """One note per trap."""
    for entry in entries(wish.bank, Trap):
        yield Note(
            key=f"trap/{entry.id}",
            kind="trap",
            form="basic",
            topic=entry.topic,
            tier=entry.tier,
            section=entry.section,
            refs=(entry.id, *entry.refs),
            langs=wish.langs,
            words={
                "Front": {
                    lang: (Label(words(lang)["wrong"]), *passage(entry, "claim", lang))
                    for lang in wish.langs
                },
                "Back": {lang: passage(entry, "right", lang) for lang in wish.langs},
            },
        )
