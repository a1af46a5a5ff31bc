"""Vocabulary: term to meaning, meaning to term, other languages to English."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from quizgen.bank.prose import Paragraph
from quizgen.cards.content import Term, entries
from quizgen.cards.kinds._authored import noted
from quizgen.cards.note import Note, Words
from quizgen.cards.wish import Wish
from quizgen.locale import FIRST
from quizgen.question.authored import passage, sentence


def notes(wish: Wish) -> Iterator[Note]:
    """One note per term; the English term is always there, because exams use it."""
    for entry in entries(wish.bank, Term):
        shown = (FIRST, *(lang for lang in wish.langs if lang != FIRST))
        said: dict[str, Words] = {
            "Term": {lang: (Paragraph(sentence(entry, "term", lang)),) for lang in shown},
            "Meaning": {lang: passage(entry, "meaning", lang) for lang in wish.langs},
        }
        refs = (f"V{entry.number:02}", *entry.refs)
        yield replace(noted(wish, entry, "vocab", said, refs), form="term")
