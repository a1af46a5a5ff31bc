r"""Printing formulas: one layout tree, four outputs (LaTeX, MathML, Typst, spoken).

In: formula trees, numbers and units as text. Out: layout nodes and what they look like in a medium.
Must never know: what a formula is worth, a template, a page.

``layout(expr)`` turns a formula tree into layout nodes; ``leaves`` puts drawn numbers in the place
of symbols; ``relation`` chains the sides of a worked line; ``latex``, ``mathml``, ``typst`` and
``spoken`` write the nodes.

Examples
--------
>>> from quizgen.maths.tree import Call, Sym
>>> from quizgen.typeset import latex, layout, name, quantity, relation, spoken
>>> f, X, Z = Sym("f"), Sym("X"), Sym("Z")
>>> expr = Call("div", (Call("mul", (f, X)), Z))
>>> numbers = {"f": quantity("50", "mm"), "X": quantity("30", "m"), "Z": quantity("600", "m")}
>>> sides = [name("u"), layout(expr), layout(expr, leaves=numbers), quantity("2.5", "mm")]
>>> line = relation(["=", "=", "="], sides)
>>> print(latex(line))  # doctest: +NORMALIZE_WHITESPACE
u = \frac{f X}{Z} = \frac{50\,\mathrm{mm} \cdot 30\,\mathrm{m} }{600\,\mathrm{m} }
= 2.5\,\mathrm{mm}
"""

from quizgen.typeset.build import (
    comma_list,
    decimal,
    fenced,
    negative,
    number,
    power_of_ten,
    quantity,
    relation,
)
from quizgen.typeset.latex import latex
from quizgen.typeset.layout import bracketed, layout, power
from quizgen.typeset.mathml import mathml
from quizgen.typeset.names import name
from quizgen.typeset.nodes import Node
from quizgen.typeset.spoken import spoken
from quizgen.typeset.typst import typst

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
