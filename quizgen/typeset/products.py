"""How factors stand beside each other: 2 x, but 2 · 3, x · 2 and f · (a + b)."""

from __future__ import annotations

from quizgen.typeset.nodes import (
    NEGATIVE,
    Accent,
    Digits,
    Fenced,
    Frac,
    Func,
    Ident,
    MathRow,
    Node,
    NumberWithUnit,
    OperatorSign,
    Scripts,
    Word,
)

_READ_AS_FUNCTION = frozenset("fghPVEFGNLφψ")
"""Letters before a bracket that readers take for a function: they get a dot."""

_TIMES, _DOT = OperatorSign(""), OperatorSign("·")


def needs_dot(left: Node, right: Node) -> OperatorSign:
    """Put a dot where juxtaposed factors would be misread."""
    before, after = _find_last_visible(left), _find_first_visible(right)
    if _starts_number(after) or isinstance(before, NumberWithUnit):
        return _DOT
    if isinstance(before, Word) or isinstance(after, Word) or _has_slash_between(left, right):
        return _DOT
    return _DOT if isinstance(after, Fenced) and _has_call_look(before, after) else _TIMES


def _has_slash_between(left: Node, right: Node) -> bool:
    """Whether one factor is a quotient with a slash, whose end would be unclear."""
    ends = _find_last_visible(left), right
    return any(isinstance(node, Frac) and node.inline for node in ends)


def _has_call_look(before: Node, after: Fenced) -> bool:
    """Whether a factor before a bracket looks like a function, or bars like one pair of bars."""
    if isinstance(before, Digits | Func):
        return after.kind == "()"
    if isinstance(before, Ident):
        return after.kind == "()" and before.text in _READ_AS_FUNCTION
    return isinstance(before, Fenced) and "|" in (before.kind[0], after.kind[0])


def _find_first_visible(node: Node) -> Node:
    """Find what a reader meets first in a factor."""
    while True:
        match node:
            case MathRow():
                node = node.items[0]
            case Scripts() | Accent():
                node = node.base
            case Frac():
                node = node.top
            case _:
                return node


def _find_last_visible(node: Node) -> Node:
    """Find what a reader meets last in a factor."""
    while True:
        match node:
            case MathRow():
                node = node.items[-1]
            case Scripts(sup=None) | Accent():
                node = node.base
            case _:
                return node


def _starts_number(node: Node) -> bool:
    """Whether a factor is a number, maybe in brackets with a sign or a unit."""
    if isinstance(node, Fenced):
        node = node.body
        if isinstance(node, MathRow) and node.level == NEGATIVE:
            node = node.items[1]
    return isinstance(node, Digits | NumberWithUnit)
