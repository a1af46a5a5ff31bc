"""Kinds of cards: one module each, one table."""

from __future__ import annotations

from collections.abc import Mapping

KINDS: Mapping[str, str] = {
    "vocab": "quizgen.cards.kinds.vocab",
    "formula": "quizgen.cards.kinds.formulas",
    "cheat": "quizgen.cards.kinds.cheat",
    "trap": "quizgen.cards.kinds.trap",
    "figure": "quizgen.cards.kinds.figure",
    "truth": "quizgen.cards.kinds.truth",
    "choice": "quizgen.cards.kinds.choice",
    "question": "quizgen.cards.kinds.question",
}
"""Kind to the module whose ``notes(wish)`` makes its notes, in the order of learning."""
