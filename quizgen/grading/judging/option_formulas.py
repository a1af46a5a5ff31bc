"""Which option has the formula that was typed, written otherwise: ``1.5 f`` for *3·f/2*."""

from __future__ import annotations

import re

from quizgen.core.errors import FormulaError
from quizgen.grading.judging.algebraic_equality import prove_equal
from quizgen.grading.reading.formulas import read_formula
from quizgen.locale.word_patterns import WordPattern, list_rows
from quizgen.maths.tree import Expr, names_in

LONGEST = 40
"""Characters of a formula that names an option."""
_SHARE_OF = WordPattern(r"(?:(?<=\s)|^)(?:«articles» )?(?P<share>«wordings.shares») «of» ")
_LETTER = re.compile(r"(?<![^\W\d_])[^\W\d_](?![^\W\d_])")
_BEHIND_WORDS = re.compile(r"(?:.*(?<![^\W\d_])[^\W\d_]{2,} )?(?P<formula>.+)", re.DOTALL)


def find_same_formula(typed: str, options: list[str]) -> int:
    """Return the place (from 1) of the only option that ends in a formula equal to one typed.

    0 if there is none or several, and for what has no letter: a number may be a place.
    """
    meant = _read_formula_behind(typed) if len(typed) <= LONGEST else None
    if meant is None:
        return 0
    listed = ((place, _read_formula_behind(one)) for place, one in enumerate(options, 1))
    same = [place for place, tree in listed if tree is not None and prove_equal(tree, meant)]
    return same[0] if len(same) == 1 else 0


def _read_formula_behind(text: str) -> Expr | None:
    """Return the formula with a letter at the end of some words, ``on a third of H``; else None."""
    shares = {word: share for share, word in list_rows("wordings.shares")}
    spelt = _SHARE_OF.sub(lambda m: f" ({shares[m['share'].casefold()]})*", text.strip(" .!"))
    match = _BEHIND_WORDS.fullmatch(spelt.strip())
    if match is None or not re.search(r"\d", match["formula"]):
        return None
    try:
        tree = read_formula(match["formula"], _LETTER.findall(match["formula"])).tree
    except FormulaError:
        return None
    return tree if names_in(tree) else None
