"""Flashcards: one deck of terms, formulas, mistakes, statements, figures and questions.

In: a bank, and a marked paper for cards of what went wrong. Out: notes, and files that Anki and
other programs import. Must never know: how a paper is printed, how an answer is marked.

``build`` makes the notes, ``quizgen.cards.apkg.package`` writes them for Anki, and
``quizgen.cards.delimited`` writes them for other programs. Every sentence of the content stands in
the bank (``templates/cards/*.toml``) in each of its languages; every formula is written
once, in the grammar that students type, and printed by ``quizgen.typeset``.
"""

from quizgen.cards.deck import Deck, build_deck
from quizgen.cards.note import Note

__all__ = ["Deck", "Note", "build_deck"]
