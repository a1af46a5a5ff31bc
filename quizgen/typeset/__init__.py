r"""Printing formulas: one layout tree, five outputs (LaTeX, MathML, Typst, spoken, plain text).

In: formula trees, LaTeX, numbers and units as text. Out: layout nodes and what they look like in a
medium. Must never know: what a formula is worth, a template, a page.

``lay_out(expr)`` turns a formula tree into layout nodes; ``leaves`` puts drawn numbers in the place
of symbols; ``relation_chain`` joins the sides of a worked line; ``from_latex`` reads what authors
write, and ``leaves`` fills its places; ``to_latex``, ``to_mathml``, ``to_typst``, ``to_speech`` and
``to_text`` write the nodes.

Examples
--------
>>> from quizgen.maths.tree import Call, Sym
>>> from quizgen.typeset import lay_out, lay_out_name, quantity, relation_chain, to_latex
>>> f, X, Z = Sym("f"), Sym("X"), Sym("Z")
>>> expr = Call("div", (Call("mul", (f, X)), Z))
>>> numbers = {"f": quantity("50", "mm"), "X": quantity("30", "m"), "Z": quantity("600", "m")}
>>> sides = [lay_out_name("u"), lay_out(expr), lay_out(expr, leaves=numbers), quantity("2.5", "mm")]
>>> line = relation_chain(["=", "=", "="], sides)
>>> print(to_latex(line))  # doctest: +NORMALIZE_WHITESPACE
u = \frac{f X}{Z} = \frac{50\,\mathrm{mm} \cdot 30\,\mathrm{m} }{600\,\mathrm{m} }
= 2.5\,\mathrm{mm}
"""

from quizgen.typeset.builders import (
    comma_list,
    decimal,
    fence,
    negative,
    number,
    power_of_ten,
    quantity,
    relation_chain,
    split_chain,
)
from quizgen.typeset.latex import to_latex
from quizgen.typeset.layout import add_brackets, lay_out, lay_out_power
from quizgen.typeset.mathml import to_mathml
from quizgen.typeset.names import lay_out_name
from quizgen.typeset.nodes import Node
from quizgen.typeset.plain import to_text
from quizgen.typeset.speech import to_speech
from quizgen.typeset.typst import to_typst

__all__ = [
    "Node",
    "add_brackets",
    "comma_list",
    "decimal",
    "fence",
    "lay_out",
    "lay_out_name",
    "lay_out_power",
    "negative",
    "number",
    "power_of_ten",
    "quantity",
    "relation_chain",
    "split_chain",
    "to_latex",
    "to_mathml",
    "to_speech",
    "to_text",
    "to_typst",
]
