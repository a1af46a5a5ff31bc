"""Words of the formula grammar: functions, constants, and how a name may be spelled."""

from __future__ import annotations

import re
from functools import cache

from quizgen.maths.operators import FURTHER, OperatorSyntax, operators_with_syntax

FUNCTIONS = {
    row.name: (row.least, row.most) for row in operators_with_syntax(OperatorSyntax.FUNCTION)
}
"""Function name to the smallest and largest number of arguments."""

LIST_FUNCTIONS = {
    sign: row for row in operators_with_syntax(OperatorSyntax.LIST) for sign in row.signs
}
"""Functions of a list, which authors type and students do not, to what they are."""

CONSTANTS = {
    sign: row.name for row in operators_with_syntax(OperatorSyntax.CONSTANT) for sign in row.signs
}
"""Spelling of a constant to its name."""

KEYWORDS = frozenset(row.name for row in operators_with_syntax(OperatorSyntax.WORD))

NAME = re.compile(r"[^\W\d_][^\W_]*'*(?:_[^\W_]+'*)*")
"""A letter, letters and digits, primes, then subscripts: ``f``, ``k_1``, ``p'_x``, ``Delta``."""

GREEK = {
    "α": "alpha",
    "β": "beta",
    "γ": "gamma",
    "δ": "delta",
    "ε": "epsilon",
    "ζ": "zeta",
    "η": "eta",
    "θ": "theta",
    "ι": "iota",
    "κ": "kappa",
    "λ": "lambda",
    "μ": "mu",
    "µ": "mu",
    "ν": "nu",
    "ξ": "xi",
    "ρ": "rho",
    "σ": "sigma",
    "τ": "tau",
    "υ": "upsilon",
    "φ": "phi",
    "χ": "chi",
    "ψ": "psi",
    "ω": "omega",
    "Γ": "Gamma",
    "Δ": "Delta",
    "∆": "Delta",
    "Θ": "Theta",
    "Λ": "Lambda",
    "Ξ": "Xi",
    "Σ": "Sigma",
    "Φ": "Phi",
    "Ψ": "Psi",
    "Ω": "Omega",
}
"""Greek letters that students type or paste, and the names authors use."""


def is_plain_name(name: str) -> bool:
    """Return whether a name can stand in a formula without back quotes."""
    # gamma and beta are letters of Greek first: functions only in front of a bracket.
    reserved = name in (CONSTANTS.keys() | KEYWORDS | FUNCTIONS.keys()) - {
        *GREEK.values(),
        *FURTHER,
    }
    return not reserved and NAME.fullmatch(name) is not None


def fold_name(name: str) -> str:
    """Return a name without subscript marks and Greek letters: ``k_1`` and ``k1`` are one."""
    if not name.isascii():
        for letter, word in GREEK.items():
            name = name.replace(letter, word)
    return name.replace("_", "")


@cache
def spellings(symbols: frozenset[str]) -> dict[str, str]:
    """Return every accepted spelling of the declared names, to the declared name.

    Two declared names that fold to one spelling keep only their exact spellings.
    """
    table: dict[str, str] = {}
    clash: set[str] = set()
    for name in sorted(symbols):
        for spelling in {fold_name(name), *_list_greek_spellings(name)}:
            clash |= {spelling} if table.get(spelling, name) != name else set()
            table[spelling] = name
    for spelling in clash:
        del table[spelling]
    return table | {name: name for name in symbols}


def _list_greek_spellings(name: str) -> set[str]:
    """Return the name with Greek letters for their words, with and without underscores."""
    return {
        name.replace(word, letter).replace("_", cut)
        for letter, word in GREEK.items()
        for cut in ("_", "")
        if word in name
    }


def split_product(word: str, symbols: frozenset[str]) -> list[list[str]]:
    """Return the ways to read an undeclared word as a product of declared names (at most two).

    Two are enough to see that it is ambiguous.
    """
    table = spellings(symbols)
    ways: list[list[list[str]]] = [[] for _ in range(len(word) + 1)]
    ways[0] = [[]]
    for end in range(1, len(word) + 1):
        for start in range(max(0, end - 24), end):
            name = table.get(word[start:end])
            if name is not None:
                ways[end] += [[*way, name] for way in ways[start]]
        ways[end] = _deduplicate_products(ways[end])[:2]
    return ways[-1]


def _deduplicate_products(ways: list[list[str]]) -> list[list[str]]:
    """Return the products without those of the same factors, which are the same reading."""
    return list({tuple(sorted(way)): way for way in ways}.values())
