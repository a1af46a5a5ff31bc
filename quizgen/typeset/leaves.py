"""Values of a draw in the places of a formula, with the signs and brackets that they need there.

``x - {{ a }}`` with a = -3 is x + 3, ``{{ a }}x`` with a = 1 is x, ``2 {{ a }}`` with a = -3 is
2·(-3). Only nodes are put in places: nothing that is drawn is read as LaTeX or as a formula.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, cast

from msgspec import Struct
from msgspec.structs import replace

from quizgen.core.errors import RenderError
from quizgen.maths.tree import Expr
from quizgen.typeset.builders import quantity
from quizgen.typeset.layout import lay_out
from quizgen.typeset.nodes import (
    ATOM,
    NEGATIVE,
    POWER,
    PRODUCT,
    RELATION,
    SUM,
    Digits,
    Fenced,
    Frac,
    Gap,
    Leaf,
    MathRow,
    Node,
    NumberWithUnit,
    OperatorSign,
    Phrase,
    Scripts,
)


class LeafValue(Struct, frozen=True):
    """What stands in a place; ``is_rounded`` turns an equals sign in front into ≈."""

    node: Node
    is_rounded: bool = False


def make_leaf_value(value: Expr | str, unit: str = "", *, is_rounded: bool = False) -> LeafValue:
    """Return what stands in a formula's place for a value.

    Parameters
    ----------
    value : Expr or str
        A formula, laid out as mathematics; or a number as text, such as ``-3`` or ``1.2e-5``.
    unit : str
        Of a number.
    is_rounded : bool
        Whether the text is not the exact value.
    """
    node = quantity(value, unit) if isinstance(value, str) else lay_out(value)
    return LeafValue(node, is_rounded)


_NEG, _MINUS, _PLUS, _DOT, _TIMES = map(OperatorSign, ("neg", "-", "+", "·", ""))
_SIGNS = (_PLUS, _MINUS, _NEG)
_ADDING = frozenset({"+", "-", "±", "∓"})
_MULTIPLYING = frozenset({"", "·", "×", "/", "÷", "mod", "∘", "⊗", "apply", "apply tight"})
_BEHIND = frozenset({"!", "°", "%"})
_UNIT = Digits("1")


def list_leaf_names(node: Node) -> frozenset[str]:
    """Return the names of the values that a formula has places for."""
    return frozenset(_iter_names(node))


def _iter_names(part: Any) -> Iterator[str]:
    """Yield the names of the leaves in a part of a layout, in order."""
    if isinstance(part, Leaf):
        yield part.name
    elif isinstance(part, Struct):
        for name in part.__struct_fields__:
            yield from _iter_names(getattr(part, name))
    elif isinstance(part, tuple):
        for one in part:
            yield from _iter_names(one)


def fill_leaves(node: Node, values: Mapping[str, LeafValue]) -> Node:
    """Return a formula with values in its places.

    Parameters
    ----------
    node : Node
        The layout, with leaves.
    values : mapping of str to LeafValue
        By the name of the leaf.

    Raises
    ------
    RenderError
        If a leaf has no value.
    """
    return _Filling(values).fill(node)


class _Filling:
    """One run: the values of a draw."""

    __slots__ = ("values",)

    def __init__(self, values: Mapping[str, LeafValue]) -> None:
        self.values = values

    def fill(self, node: Node) -> Node:
        """Return a node with its leaves filled, itself in a place where nothing needs brackets."""
        if isinstance(node, Leaf):
            return self.get(node).node
        if isinstance(node, MathRow):
            return self.fill_row(node)
        if isinstance(node, Scripts):
            return self.fill_scripts(node)
        if isinstance(node, Frac):
            return self.fill_fraction(node)
        return self.rebuild(node)

    def get(self, leaf: Leaf) -> LeafValue:
        """Return the value of a leaf."""
        found = self.values.get(leaf.name)
        if found is None:
            raise RenderError(f"there is no value for {leaf.name!r}")
        return found

    def rebuild(self, node: Node) -> Node:
        """Return the same node with its parts filled."""
        changed = {
            name: self.fill_part(part)
            for name in node.__struct_fields__
            if isinstance(part := getattr(node, name), Struct | tuple)
        }
        return replace(node, **changed) if changed else node

    def fill_part(self, part: Any) -> Any:
        """Return a part of a node: a node, rows of nodes, or nothing."""
        if isinstance(part, tuple):
            return tuple(self.fill_part(one) for one in part)
        return self.fill(cast("Node", part)) if isinstance(part, Struct) else part

    def fill_scripts(self, node: Scripts) -> Node:
        """Return a node with scripts; its base is one thing, or stands in brackets."""
        base = self.fill(node.base)
        if isinstance(node.base, Leaf) and (base.level < ATOM or isinstance(base, Scripts)):
            base = Fenced("()", base)
        sub, sup = (part and self.fill(part) for part in (node.sub, node.sup))
        if isinstance(node.sup, Leaf) and sup == Digits("1"):  # a drawn exponent
            return replace(node, base=base, sub=sub, sup=None) if sub else base
        return replace(node, base=base, sub=sub, sup=sup and _allow_slash(sup))

    def fill_fraction(self, node: Frac) -> Node:
        """Return a fraction; on a slash, values need the brackets that a bar would spare."""
        top, bottom = self.fill(node.top), self.fill(node.bottom)
        if node.inline and isinstance(node.top, Leaf) and top.level < NEGATIVE:
            top = Fenced("()", top)
        if node.inline and isinstance(node.bottom, Leaf) and bottom.level < POWER:
            bottom = Fenced("()", bottom)
        return replace(node, top=top, bottom=bottom)

    def fill_row(self, row: MathRow) -> Node:
        """Return a row, whose leaves see what stands next to them."""
        items: list[Node] = []
        for at, item in enumerate(row.items):
            before = row.items[at - 1] if at else None
            following = row.items[at + 1] if at + 1 < len(row.items) else None
            if isinstance(item, Leaf):
                self.place(items, item, following)
            elif item != _TIMES:
                self.append(items, item, before)
            elif items[-1] is not _DROPPED:
                items.append(_DOT if _ends_in_unit(items[-1]) else item)
        items = [item for item in items if item is not _DROPPED]
        negative = row.level == PRODUCT and _starts_with_minus(MathRow(tuple(items)))
        level = NEGATIVE if negative else row.level
        return items[0] if len(items) == 1 else MathRow(tuple(items), level)

    def append(self, items: list[Node], item: Node, before: Node | None) -> None:
        """Put what is no leaf after what a row has so far."""
        filled = self.fill(item)
        if filled != item and _find_last(items) in _SIGNS:
            flipped = _take_minus(filled)
            if flipped is not None:
                filled = flipped
                _turn_sign(items)
        if _touches_value(items, filled, before):
            items.append(_DOT)
        items.append(filled)

    def place(self, items: list[Node], leaf: Leaf, following: Node | None) -> None:
        """Put a value after what a row has so far."""
        value = self.get(leaf)
        node = value.node
        before = _find_last(items)
        if value.is_rounded and before == OperatorSign("="):
            items[-1] = OperatorSign("≈")
        if before in _SIGNS and (flipped := _take_minus(node)) is not None:
            node = flipped
            _turn_sign(items)
        sign = _find_last(items)
        factor = _is_factor(sign, following)
        if factor and _is_unit_factor(node, following) and not _is_multiplied(sign):
            items += _keep_sign(node)
            items.append(_DROPPED)
            return
        needed = _needed_level(sign, following, factor=factor)
        fits = needed < ATOM and _fits(node, sign, factor=factor)
        if node.level < needed and not fits:
            node = Fenced("()", node)
        if sign == _TIMES and _looks_like_number(node):
            items[-1] = _DOT
        elif _is_operand(sign) and _looks_like_number(node):
            items.append(_DOT)
        items.append(node)


_DROPPED = Phrase("\0")


def _find_last(items: list[Node]) -> Node | None:
    """Return the last node of a row that is no gap; None if there is none."""
    return next((item for item in reversed(items) if not isinstance(item, Gap)), None)


def _turn_sign(items: list[Node]) -> None:
    """Turn the sign at the end of a row over; a leading minus goes away."""
    at = max(place for place, item in enumerate(items) if not isinstance(item, Gap))
    if items[at] == _NEG:
        del items[at]
    else:
        items[at] = _PLUS if items[at] == _MINUS else _MINUS


def _take_minus(node: Node) -> Node | None:
    """Return a node without the minus sign that it begins with; None if it begins with none."""
    if not isinstance(node, MathRow) or node.level != NEGATIVE or not node.items:
        return None
    first, *rest = node.items
    if first != _NEG:
        inner = _take_minus(first)
        return None if inner is None else MathRow((inner, *rest), PRODUCT)
    return rest[0] if len(rest) == 1 else MathRow(tuple(rest), PRODUCT)


def _is_separator(node: Node | None) -> bool:
    """Whether nothing on this side holds a value."""
    if node is None or isinstance(node, Phrase):
        return True
    return isinstance(node, OperatorSign) and node.name not in _ADDING | _MULTIPLYING | _BEHIND


def _is_factor(before: Node | None, following: Node | None) -> bool:
    """Whether a value is multiplied by what stands next to it."""
    return (
        _is_operand(before)
        or _is_operand(following)
        or _is_multiplied(before)
        or (isinstance(following, OperatorSign) and following.name in _MULTIPLYING | _BEHIND)
    )


def _is_multiplied(before: Node | None) -> bool:
    """Return whether what follows is multiplied by the node before it, with or without a sign."""
    return _is_operand(before) or (
        isinstance(before, OperatorSign) and before.name in _MULTIPLYING | {"¬"}
    )


def _is_operand(node: Node | None) -> bool:
    """Return whether a node is a value, not a sign, a phrase or a gap."""
    return node is not None and not isinstance(node, OperatorSign | Phrase | Gap)


def _is_unit_factor(node: Node, following: Node | None) -> bool:
    """Whether a value is 1 or -1 in front of something that is multiplied without a sign."""
    bare = node if (taken := _take_minus(node)) is None else taken
    beside = following == OperatorSign("") or (
        _is_operand(following) and not isinstance(following, Digits | Leaf)
    )
    return bare == _UNIT and beside


def _keep_sign(node: Node) -> list[Node]:
    """Return the minus sign that a node begins with, in a list; an empty list for none."""
    return [] if _take_minus(node) is None else [_NEG]


def _needed_level(before: Node | None, following: Node | None, *, factor: bool) -> int:
    """Return how strongly a value must hold together to stand without brackets."""
    if isinstance(following, OperatorSign) and following.name in _BEHIND:
        return ATOM
    if factor:
        return PRODUCT
    if isinstance(before, OperatorSign) and before.name in _ADDING:
        return PRODUCT
    if isinstance(following, OperatorSign) and following.name in _ADDING:
        return SUM
    return SUM if before is not None or following is not None else RELATION


def _fits(node: Node, before: Node | None, *, factor: bool) -> bool:
    """Whether a weaker value is clear all the same: a sum added, a negative factor in front."""
    if factor:
        return node.level == NEGATIVE and _is_separator(before)
    if before == _PLUS and node.level == SUM:
        return not (isinstance(node, MathRow) and _starts_with_minus(node))
    return False


def _starts_with_minus(node: Node) -> bool:
    """Return whether the first sign of a node is a minus."""
    while isinstance(node, MathRow) and node.items:
        node = node.items[0]
    return node == _NEG


def _looks_like_number(node: Node) -> bool:
    """Whether a value right after a factor would be read as part of it."""
    while isinstance(node, Fenced) and node.kind == "()":
        node = node.body
    if isinstance(node, MathRow) and node.items:
        node = node.items[1] if node.items[0] == _NEG and len(node.items) > 1 else node.items[0]
    if isinstance(node, Scripts):
        node = node.base
    return isinstance(node, Digits | NumberWithUnit | Frac)


def _ends_in_unit(node: Node) -> bool:
    """Whether a factor right after a value would be read as part of its unit, or of a fraction."""
    while isinstance(node, MathRow) and node.items:
        node = node.items[-1]
    return isinstance(node, NumberWithUnit) or (isinstance(node, Frac) and node.inline)


def _touches_value(items: list[Node], node: Node, before: Node | None) -> bool:
    """Whether what comes right after a value would be read as part of it."""
    last = _find_last(items)
    if not isinstance(before, Leaf) or last is None or not _is_operand(last) or last is _DROPPED:
        return False
    product = isinstance(last, MathRow) and last.level == PRODUCT
    return isinstance(node, Digits) or (_is_operand(node) and (product or _ends_in_unit(last)))


def _allow_slash(node: Node) -> Node:
    """Return a fraction of numbers in an exponent as one on a single line."""
    if isinstance(node, Frac) and isinstance(node.top, Digits):
        return replace(node, inline=True)
    return node
