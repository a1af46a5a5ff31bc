"""Kinds of cards: one module each, one table.

In: a wish (bank, languages, topics, seed). Out: notes, in the order of learning. Must never know:
the program that shows them.
"""

from __future__ import annotations

from collections.abc import Mapping

from quizgen.cards.kinds import cheat_sheet, choice, figure, formula, question, trap, truth, vocab
from quizgen.cards.request import CardKind

QUESTION = "question"
"""The kind that draws and solves."""

KINDS: Mapping[str, CardKind] = {
    "vocab": vocab.notes,
    "formula": formula.notes,
    "cheat": cheat_sheet.notes,
    "trap": trap.notes,
    "figure": figure.notes,
    "truth": truth.notes,
    "choice": choice.notes,
    QUESTION: question.notes,
}
"""Kind to what makes its notes, in the order of learning."""
