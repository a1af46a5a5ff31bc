r"""Printing formulas: one layout tree, four outputs (LaTeX, MathML, Typst, spoken).

``layout(expr)`` turns a formula tree into layout nodes; ``leaves`` puts drawn numbers in the place
of symbols; ``relation`` chains the sides of a worked line; ``latex``, ``mathml``, ``typst`` and
``spoken`` write the nodes.

Examples
--------
>>> from quizgen.maths.tree import Call, Sym
>>> from quizgen.formula import latex, layout, name, quantity, relation, spoken
>>> f, X, Z = Sym("f"), Sym("X"), Sym("Z")
>>> expr = Call("div", (Call("mul", (f, X)), Z))
>>> numbers = {"f": quantity("50", "mm"), "X": quantity("30", "m"), "Z": quantity("600", "m")}
>>> sides = [name("u"), layout(expr), layout(expr, leaves=numbers), quantity("2.5", "mm")]
>>> line = relation(["=", "=", "="], sides)
>>> print(latex(line))  # doctest: +NORMALIZE_WHITESPACE
u = \frac{f X}{Z} = \frac{50\,\mathrm{mm} \cdot 30\,\mathrm{m} }{600\,\mathrm{m} }
= 2.5\,\mathrm{mm}
"""

from quizgen.formula.build import (
    comma_list,
    decimal,
    fenced,
    negative,
    number,
    power_of_ten,
    quantity,
    relation,
)
from quizgen.formula.names import name
from quizgen.formula.nodes import Node
from quizgen.formula.to_latex import latex
from quizgen.formula.to_mathml import mathml
from quizgen.formula.to_spoken import spoken
from quizgen.formula.to_typst import typst
from quizgen.formula.tree import bracketed, layout, power

__all__ = [
    "Node",
    "bracketed",
    "comma_list",
    "decimal",
    "fenced",
    "latex",
    "layout",
    "mathml",
    "name",
    "negative",
    "number",
    "power",
    "power_of_ten",
    "quantity",
    "relation",
    "spoken",
    "typst",
]
