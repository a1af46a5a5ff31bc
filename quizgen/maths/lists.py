"""Functions of lists for solvers: ``Step(m, mean(x), "cm")`` where ``x`` is a drawn list.

They stand for their values and compute nothing: SymPy only carries them to the formula.

Examples
--------
>>> from sympy import symbols
>>> from quizgen.maths.from_sympy import from_sympy
>>> from quizgen.maths.lists import mean
>>> from quizgen.maths.notation import format_tree
>>> format_tree(from_sympy(mean(symbols("x")) / 2))
'mean(x)/2'
"""

from __future__ import annotations

from typing import ClassVar

import sympy

from quizgen.maths.operators import OperatorSyntax, operators_with_syntax


class ListFunction(sympy.Function):  # type: ignore[misc]  # SymPy has no types
    """A function of a list; ``op`` is its name in the table of operators."""

    op: ClassVar[str]


_MADE: dict[str, type[ListFunction]] = {
    row.signs[0]: type(row.signs[0], (ListFunction,), {"op": row.name, "nargs": row.least})
    for row in operators_with_syntax(OperatorSyntax.LIST)
}

mean, median, quantile = _MADE["mean"], _MADE["median"], _MADE["quantile"]
var, sd, pvar, psd = _MADE["var"], _MADE["sd"], _MADE["pvar"], _MADE["psd"]
cov, corr, slope = _MADE["cov"], _MADE["corr"], _MADE["slope"]
sort, at = _MADE["sort"], _MADE["at"]
# Named as in formulas; a solver imports them by name and then means these.
sum, min, max, len = _MADE["sum"], _MADE["min"], _MADE["max"], _MADE["len"]  # noqa: A001

__all__ = [
    "at", "corr", "cov", "len", "max", "mean", "median", "min", "psd", "pvar",
    "quantile", "sd", "slope", "sort", "sum", "var",
]  # fmt: skip
