"""Vocabulary: term to meaning, meaning to term, other languages to English."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from quizgen.cards.content import VocabularyEntry, read_card_entries
from quizgen.cards.kinds._entry_note import entry_note
from quizgen.cards.note import CardWords, Note
from quizgen.cards.request import DeckRequest
from quizgen.locale import FIRST, default_language
from quizgen.question.entry_prose import entry_blocks, entry_inlines
from quizgen.typeset.prose import Paragraph


def notes(wish: DeckRequest) -> Iterator[Note]:
    """Yield one note per term, always with the English term, because exams use it.

    In a bank without English the term in its own first language stands in its place.
    """
    for entry in read_card_entries(wish.bank, VocabularyEntry):
        named = {lang: lang for lang in wish.langs} | {FIRST: default_language(tuple(entry.term))}
        others = [lang for lang in wish.langs if lang not in (FIRST, named[FIRST])]
        said: dict[str, CardWords] = {
            "Term": {
                lang: (Paragraph(entry_inlines(entry, "term", named[lang])),)
                for lang in (FIRST, *others)
            },
            "Meaning": {lang: entry_blocks(entry, "meaning", lang) for lang in wish.langs},
        }
        refs = (f"V{entry.number:02}", *entry.refs)
        yield replace(entry_note(wish, entry, "vocab", said, refs), form="term")
