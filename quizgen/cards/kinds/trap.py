"""Traps: a wrong claim on the front, what is wrong and the right way on the back."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.cards.content import Trap, entries, words
from quizgen.cards.kinds._authored import noted
from quizgen.cards.note import Note, Words
from quizgen.cards.prose import Label
from quizgen.cards.wish import Wish
from quizgen.question.authored import passage


def notes(wish: Wish) -> Iterator[Note]:
    """One note per trap."""
    for entry in entries(wish.bank, Trap):
        sides: dict[str, Words] = {
            "Front": {
                lang: (Label(words(lang)["wrong"]), *passage(entry, "claim", lang))
                for lang in wish.langs
            },
            "Back": {lang: passage(entry, "right", lang) for lang in wish.langs},
        }
        yield noted(wish, entry, "trap", sides, (entry.id, *entry.refs))
