"""The cheat sheet, entry by entry."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.cards.content import Cheat, entries
from quizgen.cards.kinds._authored import noted
from quizgen.cards.note import Note
from quizgen.cards.wish import Wish
from quizgen.question.authored import passage


def notes(wish: Wish) -> Iterator[Note]:
    """One note per entry of the cheat sheet."""
    for entry in entries(wish.bank, Cheat):
        sides = {
            "Front": {lang: passage(entry, "ask", lang) for lang in wish.langs},
            "Back": {lang: passage(entry, "answer", lang) for lang in wish.langs},
        }
        yield noted(wish, entry, "cheat", sides, entry.refs)
