"""The last resort for undecided formulas: SymPy, in a process that can be killed."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from functools import reduce
from typing import Any

from msgspec.structs import replace

from quizgen.maths.notation import format_tree, parse_formula
from quizgen.maths.number_systems import compile_expr, sympy_system
from quizgen.maths.operators import CONDITIONS
from quizgen.maths.tree import Expr, names_in

SECONDS = 4.0
"""Time limit of the whole attempt, start-up included."""


def decide_by_sympy(
    first: Expr, second: Expr, symbols: Mapping[str, object], seconds: float = SECONDS
) -> bool | None:
    """Return whether two formulas are equal, by simplifying their difference; None if undecided.

    It is undecided when SymPy cannot tell, does not end within ``seconds``, or cannot be started.
    The formulas travel as text of the formula grammar and are rebuilt node by node, so nothing
    that was typed is ever evaluated as code.
    """
    if "whole" in symbols.values():
        return None  # as of real numbers, cos(pi*n) is not (-1)^n
    import subprocess  # hardly a formula stays undecided

    positive = ",".join(sorted(n for n, domain in symbols.items() if domain == "positive"))
    command = [sys.executable, "-m", "quizgen.grading.judging.sympy_equality", positive]
    try:
        done = subprocess.run(
            command,
            input=f"{format_tree(first)}\n{format_tree(second)}",
            capture_output=True,
            text=True,
            timeout=seconds,
            check=False,
        )
    except (subprocess.TimeoutExpired, OSError):
        return None
    return {"equal": True, "different": False}.get(done.stdout.strip())


def run_decider() -> None:
    """Print ``equal``, ``different`` or ``unknown`` for two formulas of standard input.

    One formula stands in each line; the first argument of the command names the positive
    quantities, with commas between.
    """
    first, second = sys.stdin.read().split("\n")[:2]
    positive = frozenset(filter(None, sys.argv[1].split(",")))
    sys.stdout.write(decide_equality(first, second, positive))


def decide_equality(first: str, second: str, positive: frozenset[str]) -> str:
    """Return ``equal``, ``different`` or ``unknown`` for two formulas as text.

    ``positive`` names the quantities above 0; all others are real.
    """
    import sympy

    try:
        a, b = (to_sympy(parse_formula(text), positive) for text in (first, second))
    except KeyError:
        return "unknown"
    difference = reduce(lambda value, step: step(value), (sympy.expand, sympy.simplify), a - b)
    if difference == 0:
        return "equal"
    return "different" if difference.is_nonzero else "unknown"


def to_sympy(tree: Expr, positive: frozenset[str], *, real: bool = True) -> Any:
    """Return the SymPy object of a tree; without ``real``, its names stand for any number.

    Raises
    ------
    KeyError
        For a condition, whose difference means nothing.
    """
    import sympy

    ops = {name: op for name, op in sympy_system().ops.items() if name not in CONDITIONS}
    kinds = {name: "positive" if name in positive else "real" for name in names_in(tree)}
    symbols = {
        name: sympy.Symbol(name, **({kind: True} if real else {})) for name, kind in kinds.items()
    }
    return compile_expr(tree, replace(sympy_system(), ops=ops))(symbols)


if __name__ == "__main__":
    run_decider()
