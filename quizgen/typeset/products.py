"""How factors stand beside each other: 2 x, but 2 · 3, x · 2 and f · (a + b)."""

from __future__ import annotations

from quizgen.typeset.nodes import (
    NEGATIVE,
    Accent,
    Fence,
    Frac,
    Func,
    Ident,
    Node,
    Number,
    Op,
    Quantity,
    Row,
    Scripts,
    Word,
)

_READ_AS_FUNCTION = frozenset("fghPVEFGNLφψ")
"""Letters before a bracket that readers take for a function: they get a dot."""

_TIMES, _DOT = Op(""), Op("·")


def between(left: Node, right: Node) -> Op:
    """Put a dot where juxtaposed factors would be misread."""
    before, after = _last(left), _first(right)
    if _starts_number(after) or isinstance(before, Quantity):
        return _DOT
    if isinstance(before, Word) or isinstance(after, Word) or _slashed(left, right):
        return _DOT
    return _DOT if isinstance(after, Fence) and _calls(before, after) else _TIMES


def _slashed(left: Node, right: Node) -> bool:
    """Whether one factor is a quotient with a slash, whose end would be unclear."""
    ends = _last(left), right
    return any(isinstance(node, Frac) and node.inline for node in ends)


def _calls(before: Node, after: Fence) -> bool:
    """Whether a factor before a bracket looks like a function, or bars like one pair of bars."""
    if isinstance(before, Number | Func):
        return after.kind == "()"
    if isinstance(before, Ident):
        return after.kind == "()" and before.text in _READ_AS_FUNCTION
    return isinstance(before, Fence) and "|" in (before.kind[0], after.kind[0])


def _first(node: Node) -> Node:
    """Find what a reader meets first in a factor."""
    while True:
        match node:
            case Row():
                node = node.items[0]
            case Scripts() | Accent():
                node = node.base
            case Frac():
                node = node.top
            case _:
                return node


def _last(node: Node) -> Node:
    """Find what a reader meets last in a factor."""
    while True:
        match node:
            case Row():
                node = node.items[-1]
            case Scripts(sup=None) | Accent():
                node = node.base
            case _:
                return node


def _starts_number(node: Node) -> bool:
    """Whether a factor is a number, maybe in brackets with a sign or a unit."""
    if isinstance(node, Fence):
        node = node.body
        if isinstance(node, Row) and node.level == NEGATIVE:
            node = node.items[1]
    return isinstance(node, Number | Quantity)
