"""Formula trees as SymPy objects, built node by node. Only ``settling``'s process imports this."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from typing import Any

import sympy

from quizgen.maths.notation import parse
from quizgen.maths.tree import Call, Expr, Num, Sym

_OPS: dict[str, Callable[..., Any]] = {
    "add": sympy.Add,
    "mul": sympy.Mul,
    "sub": lambda a, b: a - b,
    "neg": lambda a: -a,
    "div": lambda a, b: a / b,
    "pow": lambda a, b: a**b,
    "log2": lambda a: sympy.log(a) / sympy.log(2),
    "log10": lambda a: sympy.log(a) / sympy.log(10),
    "ln": sympy.log,
    "abs": sympy.Abs,
    "ceil": sympy.ceiling,
    "mod": sympy.Mod,
    "min": sympy.Min,
    "max": sympy.Max,
    "pi": lambda: sympy.pi,
    "round": lambda a: sympy.sign(a) * sympy.floor(abs(a) + sympy.Rational(1, 2)),
}
_SAME = frozenset(
    {
        "sqrt",
        "exp",
        "sin",
        "cos",
        "tan",
        "asin",
        "acos",
        "atan",
        "atan2",
        "erf",
        "erfc",
        "sign",
        "floor",
    }
)


def build(tree: Expr, positive: frozenset[str]) -> Any:
    """Build the SymPy object of a tree.

    Raises
    ------
    KeyError
        If an operator has no counterpart.
    """
    if isinstance(tree, Num):
        return sympy.Rational(tree.value.numerator, tree.value.denominator)
    if isinstance(tree, Sym):
        known = {"positive": True} if tree.name in positive else {"real": True}
        return sympy.Symbol(tree.name, **known)
    args = [build(arg, positive) for arg in tree.args]
    operation = getattr(sympy, tree.op) if tree.op in _SAME else _OPS[tree.op]
    return operation(*args)


def decide(first: str, second: str, positive: frozenset[str]) -> str:
    """Simplify the difference of two formulas: ``equal``, ``different`` or ``unknown``."""
    try:
        a, b = (build(parse(text), positive) for text in (first, second))
    except KeyError:
        return "unknown"
    difference = reduce(lambda value, step: step(value), (sympy.expand, sympy.simplify), a - b)
    if difference == 0:
        return "equal"
    return "different" if difference.is_nonzero else "unknown"


__all__ = ["Call", "build", "decide"]
