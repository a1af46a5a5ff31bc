"""Formula trees: the one form between every source of formulas and every use.

A solver's SymPy chain, mathematics typed by an author and mathematics typed by a student all become
trees; exact values, certified balls, floats, arrays and print all come from them. Nothing here
calls SymPy or runs text as code.

``Num(Fraction)``, ``Sym(name)`` and ``Call(op, args)`` are the only nodes; ``operators`` lists what
may stand in ``op``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import TypeAlias, TypeGuard

import msgspec

from quizgen.maths.operators import BINDERS


class Num(msgspec.Struct, frozen=True, tag="n", array_like=True):
    """A rational constant; ``decimal`` asks printers for 2.2 instead of 11/5."""

    value: Fraction
    decimal: bool = False


class Sym(msgspec.Struct, frozen=True, tag="s", array_like=True):
    """A named quantity."""

    name: str


class Call(msgspec.Struct, frozen=True, tag="c", array_like=True):
    """An operator or function applied to arguments."""

    op: str
    args: tuple[Expr, ...]


Expr: TypeAlias = Num | Sym | Call
"""A formula."""


def is_expr(value: object) -> TypeGuard[Expr]:
    """Whether a value is a formula, and not a number."""
    return isinstance(value, Num | Sym | Call)


def make_number(value: int | str | Fraction) -> Num:
    """Return the constant node of an integer, a fraction or a decimal text."""
    decimal = isinstance(value, str) and "." in value
    return Num(Fraction(value), decimal)


def walk_tree(expr: Expr) -> Iterator[Expr]:
    """Yield every node of a tree, parents first."""
    todo = [expr]
    while todo:
        node = todo.pop()
        yield node
        if isinstance(node, Call):
            todo += node.args[::-1]


def names_in(expr: Expr) -> frozenset[str]:
    """Return the names of the quantities that occur in a tree."""
    found, todo = set[str](), [expr]
    while todo:
        node = todo.pop()
        if isinstance(node, Call):
            if node.op in BINDERS and isinstance(node.args[0], Sym):
                found |= names_in(node.args[3]) - {node.args[0].name}
                todo += node.args[1:3]
            else:
                todo += node.args
        elif isinstance(node, Sym):
            found.add(node.name)
    return frozenset(found)


def operators_in(expr: Expr) -> frozenset[str]:
    """Return the names of the operators that occur in a tree."""
    found, todo = set[str](), [expr]
    while todo:
        node = todo.pop()
        if isinstance(node, Call):
            found.add(node.op)
            todo += node.args
    return frozenset(found)


def substitute(expr: Expr, values: Mapping[str, Expr]) -> Expr:
    """Return a tree with named quantities replaced by other trees."""
    if isinstance(expr, Sym):
        return values.get(expr.name, expr)
    if isinstance(expr, Call):
        if expr.op in BINDERS and isinstance(expr.args[0], Sym):
            values = {name: tree for name, tree in values.items() if name != expr.args[0].name}
        return Call(expr.op, tuple(substitute(arg, values) for arg in expr.args))
    return expr


__all__ = [
    "Call",
    "Expr",
    "Num",
    "Sym",
    "is_expr",
    "make_number",
    "names_in",
    "operators_in",
    "substitute",
    "walk_tree",
]
