"""What stands between the values of a list: a comma, unless the numbers in it have commas."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct

from quizgen.locale import get_language
from quizgen.typeset.nodes import Digits, Node, OperatorSign

COMMA, SEMICOLON = OperatorSign(","), OperatorSign(";")


def list_separator(items: Sequence[Node], lang: str) -> OperatorSign:
    """The sign between items in a language: ``(1.5, 2)``, but ``(1,5; 2)``."""
    commas = get_language(lang).decimal == "," and any(map(_has_decimals, items))
    return SEMICOLON if commas else COMMA


def insert_separators(items: tuple[Node, ...], lang: str) -> tuple[Node, ...]:
    """Items of a row with the separators between them as a language has them."""
    if COMMA not in items or list_separator(items, lang) == COMMA:
        return items
    return tuple([SEMICOLON if item == COMMA else item for item in items])


def _has_decimals(node: object) -> bool:
    if isinstance(node, Digits):
        return "." in node.text
    if isinstance(node, tuple):
        return any(map(_has_decimals, node))
    if isinstance(node, Struct):
        return any(_has_decimals(getattr(node, name)) for name in node.__struct_fields__)
    return False
