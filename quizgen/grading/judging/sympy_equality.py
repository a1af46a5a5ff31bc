"""The last resort for undecided formulas: SymPy, in a process that can be killed."""

from __future__ import annotations

import sys
from collections.abc import Mapping

from quizgen.maths.notation import format_tree
from quizgen.maths.tree import Expr

SECONDS = 4.0
"""Time limit of the whole attempt, start-up included."""


def decide_by_sympy(
    first: Expr, second: Expr, symbols: Mapping[str, object], seconds: float = SECONDS
) -> bool | None:
    """Decide by simplifying the difference; None if that does not end in time.

    The formulas travel as text of the formula grammar and are rebuilt node by node, so nothing
    that was typed is ever evaluated as code.
    """
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
    """Read two formulas from standard input and print ``equal``, ``different`` or ``unknown``."""
    from quizgen.grading.judging.sympy_form import decide_equality

    first, second = sys.stdin.read().split("\n")[:2]
    positive = frozenset(filter(None, sys.argv[1].split(",")))
    sys.stdout.write(decide_equality(first, second, positive))


if __name__ == "__main__":
    run_decider()
