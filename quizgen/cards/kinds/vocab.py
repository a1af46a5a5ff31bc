"""Vocabulary: term to meaning, meaning to term, other languages to English."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from quizgen.bank.prose import Paragraph
from quizgen.cards.content import Term, entries
from quizgen.cards.kinds._authored import noted
from quizgen.cards.note import Note, Words
from quizgen.cards.wish import Wish
from quizgen.locale import FIRST, leading
from quizgen.question.authored import passage, sentence


def notes(wish: Wish) -> Iterator[Note]:
    """One note per term; the English term is always there, because exams use it.

    In a bank without English the term in its own first language stands in its place.
    """
    for entry in entries(wish.bank, Term):
        named = {lang: lang for lang in wish.langs} | {FIRST: leading(tuple(entry.term))}
        others = [lang for lang in wish.langs if lang not in (FIRST, named[FIRST])]
        said: dict[str, Words] = {
            "Term": {
                lang: (Paragraph(sentence(entry, "term", named[lang])),)
                for lang in (FIRST, *others)
            },
            "Meaning": {lang: passage(entry, "meaning", lang) for lang in wish.langs},
        }
        refs = (f"V{entry.number:02}", *entry.refs)
        yield replace(noted(wish, entry, "vocab", said, refs), form="term")
