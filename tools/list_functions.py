"""Write docs/functions.md: what a step of a solver and a typed formula may use, from the table."""

from __future__ import annotations

from pathlib import Path

import sympy

from quizgen.maths.from_sympy import REWRITES
from quizgen.maths.operators import (
    BINDERS,
    CHECKED,
    CONDITIONS,
    DISTRIBUTIONS,
    FURTHER,
    OPERATORS,
    Operator,
    OperatorSyntax,
)

PAGE = Path(__file__).parent.parent / "docs" / "functions.md"

SPELLINGS = {
    "log2": "`log(a, 2)`",
    "log10": "`log(a, 10)`",
    "round": "",
    "piecewise": "`Piecewise((a, b), (c, True))`",
    "pow": "`**`",
}
"""Operators that SymPy spells otherwise."""

HEAD = """# What a step may use

*For authors of questions. To look things up.*

This page is made from the table of operators (`quizgen/maths/operators.py`) by
`uv run python tools/list_functions.py`. A step of a solver is any SymPy expression that comes to
these; what is typed by students and in `template.toml` is read by the same names.

Values are *exact* where they are rational, also at the angles whose sine, cosine or tangent is
rational (`cos(pi/2)` is 0). Others are a *ball*: an interval that is proved to hold the value. An
integral that has no formula is *checked*: computed at two precisions that must agree in 25
digits. `quizgen lint` says the least certain of these for each template, and a key lists the
steps that are only checked.

| typed | in SymPy | irrational values |
|---|---|---|
"""

TAIL = """
Under SymPy's names, too: {further}. Those of whole numbers are exact. What SymPy has no class for,
as `gcd` or `isprime`, waits for the drawn numbers by itself, and so do `numer`, `denom`, the
`rank()` of a matrix up to 4 by 4 and `a == b`. What would say something else of letters than of
numbers, as `rref()`, is refused with its line.

Beside them a step may hold what SymPy works out when the solver is compiled: `diff`, `integrate`,
`limit`, `Derivative`, `Integral`, `Limit`, `Subs`, `det`, `inv`, matrix products, `re`, `im`,
`conjugate`, `arg`, `Abs` and `I`; and {others}, which are written by the functions above.
Inside `with evaluate(False)`, too, `diff`, `integrate`, `solve` and the like are worked out, while
formulas stay as they are written.

A step is a **form** and no number if its formula holds a name of `free` (`Model(free=("x",),
...)`), or is a complex number, a `Matrix`, an `Interval`, a `Union`, a `FiniteSet` or an `Eq`.
Drawn numbers are put in and like terms put together, so that
`expand((x - p)*(x - q))` prints as x² - 5x + 6. Later steps see it in place: `Step(f, a*x**2)`
with `f = Function("f")(x)`, then `Step(df, diff(f, x))` and `Step(D, df.subs(x, c))`;
`A = MatrixSymbol("A", 2, 2)`, then `Step(d, det(A))`. In words `{{{{ f }}}}` prints it with the
drawn numbers, and `of = "df"` asks for it.

Next: [Units](units.md)
"""


def describe_operator(row: Operator) -> str:
    """Return the line of one operator."""
    if row.name in BINDERS:
        typed = f"`{row.name}(k, 1, n, ...)`"
        name = f"`{row.name.capitalize()}(..., (k, 1, n))`"
    else:
        arguments = ", ".join("abcd"[: max(1, min(row.least, 4))])
        typed = f"`{row.name}({arguments})`"
        name = f"`{row.function_in('sympy')}`"
        if row.typed is not OperatorSyntax.FUNCTION:
            typed = ", ".join(f"`{sign}`" for sign in row.signs)
        if not hasattr(sympy, row.function_in("sympy")):
            name = SPELLINGS.get(row.name, f"`{(row.signs or (row.name,))[0]}`")
    if row.name in DISTRIBUTIONS:
        name = f'`Function("{row.name}")`'
    certain = "checked" if row.name in CHECKED else "" if row.name in CONDITIONS else "ball"
    return f"| {typed} | {name} | {certain} |".replace("|a", r"\\|a")


def build_page() -> str:
    """Return the whole page."""
    others = ", ".join(f"`{one.__name__}`" for one in REWRITES if isinstance(one, type(sympy.coth)))
    further = ", ".join(f"`{name}`" for name in FURTHER)
    listed = [row for name, row in OPERATORS.items() if name not in FURTHER]
    rows = "\n".join(map(describe_operator, listed))
    return HEAD + rows + "\n" + TAIL.format(others=others, further=further)


if __name__ == "__main__":
    PAGE.write_text(build_page(), "utf-8")
