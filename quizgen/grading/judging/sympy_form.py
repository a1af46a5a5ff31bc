"""Formula trees as SymPy objects, built node by node. Only ``settling``'s process imports this."""

from __future__ import annotations

from functools import reduce
from typing import Any

import sympy
from msgspec.structs import replace

from quizgen.maths.notation import parse_formula
from quizgen.maths.number_systems import compile_expr, sympy_system
from quizgen.maths.operators import CONDITIONS
from quizgen.maths.tree import Expr, names_in


def to_sympy(tree: Expr, positive: frozenset[str]) -> Any:
    """Build the SymPy object of a tree.

    Raises
    ------
    KeyError
        If it holds a condition or a choice, which say nothing about a difference.
    """
    ops = {name: op for name, op in sympy_system().ops.items() if name not in CONDITIONS}
    symbols = {n: _make_symbol(n, positive=n in positive) for n in names_in(tree)}
    return compile_expr(tree, replace(sympy_system(), ops=ops))(symbols)


def _make_symbol(name: str, *, positive: bool) -> sympy.Symbol:
    return sympy.Symbol(name, positive=True) if positive else sympy.Symbol(name, real=True)


def decide_equality(first: str, second: str, positive: frozenset[str]) -> str:
    """Simplify the difference of two formulas: ``equal``, ``different`` or ``unknown``."""
    try:
        a, b = (to_sympy(parse_formula(text), positive) for text in (first, second))
    except KeyError:
        return "unknown"
    difference = reduce(lambda value, step: step(value), (sympy.expand, sympy.simplify), a - b)
    if difference == 0:
        return "equal"
    return "different" if difference.is_nonzero else "unknown"


__all__ = ["decide_equality", "to_sympy"]
