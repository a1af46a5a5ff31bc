"""Flashcards: one deck of terms, formulas, mistakes, statements, figures and questions.

``build`` makes the notes, ``quizgen.cards.apkg.package`` writes them for Anki, and
``quizgen.cards.tables`` writes them for other programs. Every sentence of the content stands in
``content/*.toml`` in English and Bangla; every formula is written once, in the grammar that
students type, and printed by ``quizgen.typeset``.
"""

from quizgen.cards.deck import Deck, build
from quizgen.cards.note import Note

__all__ = ["Deck", "Note", "build"]
