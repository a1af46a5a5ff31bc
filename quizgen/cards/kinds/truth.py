"""True or false, and why."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.bank.prose import Paragraph, Styled, Words
from quizgen.cards.content import Statement, entries, words
from quizgen.cards.kinds._authored import noted
from quizgen.cards.note import Blocks, Note
from quizgen.cards.prose import Label
from quizgen.cards.wish import Wish
from quizgen.question.authored import passage


def notes(wish: Wish) -> Iterator[Note]:
    """One note per statement."""
    for entry in entries(wish.bank, Statement):
        sides = {
            "Front": {
                lang: (Label(words(lang)["truth"]), *passage(entry, "text", lang))
                for lang in wish.langs
            },
            "Back": {lang: _verdict(entry, lang) for lang in wish.langs},
        }
        yield noted(wish, entry, "truth", sides, entry.refs)


def _verdict(entry: Statement, lang: str) -> Blocks:
    verdict = Words(words(lang)["true" if entry.true else "false"])
    return Paragraph((Styled("strong", (verdict,)),)), *passage(entry, "why", lang)
