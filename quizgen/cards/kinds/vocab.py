"""Vocabulary: term to meaning, meaning to term, other languages to English."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.bank.prose import Paragraph
from quizgen.cards.content import Term, entries, passage, sentence
from quizgen.cards.note import Note
from quizgen.cards.wish import Wish
from quizgen.locale import FIRST


def notes(wish: Wish) -> Iterator[Note]:
    """One note per term; the English term is always there, because exams use it."""
    for entry in entries(wish.bank, Term):
        shown = (FIRST, *(lang for lang in wish.langs if lang != FIRST))
        yield Note(
            key=f"vocab/{entry.id}",
            kind="vocab",
            form="term",
            topic=entry.topic,
            tier=entry.tier,
            section=entry.section,
            refs=(f"V{entry.number:02}", *entry.refs),
            langs=wish.langs,
            words={
                "Term": {lang: (Paragraph(sentence(entry, "term", lang)),) for lang in shown},
                "Meaning": {lang: passage(entry, "meaning", lang) for lang in wish.langs},
            },
        )
