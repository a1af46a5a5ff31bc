"""Typed mathematics to formula trees and back.

In: text in the formula grammar, and the names that may occur. Out: trees, or a
``FormulaReadError`` with the column. Must never know: how students spell, a language, how a formula
is printed.

``parse_formula`` reads the strict notation of authors: decimal point, declared names, explicit
products (or juxtaposition of declared names). ``format_tree`` writes a tree in the same
notation. Students' spelling is normalised first (``quizgen.grading.reading``) and ends in
the same grammar.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from quizgen.maths.notation.lexer import (
    FormulaReadError,
    Token,
    find_ambiguous_division,
    parse_number_literal,
    tokenize,
)
from quizgen.maths.notation.names import CONSTANTS, FUNCTIONS
from quizgen.maths.notation.parser import build_tree
from quizgen.maths.notation.printer import format_tree
from quizgen.maths.tree import Call, Expr

LONGEST = 4000
"""Most characters in an author's formula."""

_INDEXED = re.compile(r"([^\W\d]\w*)\[([^\[\]]*)\]")

DEEPEST = 100
"""Most levels of nesting in a formula."""


def parse_formula(text: str, *, symbols: Iterable[str] | None = None) -> Expr:
    """Return the tree of an author's formula.

    Parameters
    ----------
    text : str
        For example ``f*X/Z``, ``sqrt(x^2 + y^2) <= 1 and x > 0``, ``2 f X`` (declared names).
    symbols : iterable of str, optional
        The names that may occur; without it any name may.

    Notes
    -----
    ``x[3]`` is the third value of a list, the same as ``at(x, 3)``.

    Raises
    ------
    FormulaReadError
        With the column and what was expected (a ``FormulaError``).
    """
    if len(text) > LONGEST:
        raise FormulaReadError("too-long", LONGEST + 1)
    text = _INDEXED.sub(r"at(\1, \2)", text)
    pieces = tokenize(text, None if symbols is None else frozenset(symbols))
    doubtful = find_ambiguous_division(pieces)
    if doubtful is not None:
        raise FormulaReadError("two-readings", doubtful.column, doubtful.text, ["/(…)", "*"])
    return parse_tokens(pieces, len(text), tight=False)


def parse_tokens(pieces: list[Token], length: int, *, tight: bool) -> Expr:
    """Return the tree of some tokens, at most ``DEEPEST`` levels deep.

    With ``tight`` juxtaposition binds stronger than a division sign: ``a/b c`` is ``a/(b c)``.

    Raises
    ------
    FormulaReadError
        With the column and what was expected.
    """
    if not pieces:
        raise FormulaReadError("empty", 1)
    if not tight:
        pieces = [
            Token("TIMES", p.value, p.text, p.column) if p.kind == "JOIN" else p for p in pieces
        ]
    tree = build_tree(pieces, length)
    if tree_depth(tree) > DEEPEST:
        raise FormulaReadError("too-deep", 1)
    return tree


def tree_depth(expr: Expr) -> int:
    """Return the levels of nesting of a tree, counted without recursion.

    It is what keeps deep trees from functions that do recurse.
    """
    level, layer = 0, [expr]
    while layer:
        level += 1
        layer = [arg for node in layer if isinstance(node, Call) for arg in node.args]
    return level


__all__ = [
    "CONSTANTS",
    "FUNCTIONS",
    "FormulaReadError",
    "find_ambiguous_division",
    "format_tree",
    "parse_formula",
    "parse_number_literal",
    "parse_tokens",
    "tokenize",
    "tree_depth",
]
