r"""LaTeX that formulas may hold: the list that docs/formulas.md prints and errors choose from."""

from __future__ import annotations

import re

from quizgen.typeset.names import GREEK
from quizgen.typeset.signs import ARROWS, BINARY, LARGE, LETTERLIKE, PLAIN, RELATIONS

ENVIRONMENTS = (
    "matrix", "pmatrix", "bmatrix", "Bmatrix", "vmatrix", "Vmatrix", "cases", "aligned",
    "gathered", "array",
)  # fmt: skip

_OWN_COMMANDS = "there are no commands of one's own; write the formula out"
_COLOUR = "colour is lost on paper and in speech"
_NUMBERED = "formulas in a sentence have no numbers"
_QUANTITY = r"write the number and \,\mathrm{m}, or {{ name }} of a quantity with its unit"
ADVICE = {
    "ce": r"chemical formulas are written as they look: \mathrm{H_2O}, \mathrm{Ca}^{2+}",
    "SI": _QUANTITY,
    "qty": _QUANTITY,
    "si": r"write units upright: \mathrm{m/s}",
    "unit": r"write units upright: \mathrm{m/s}",
    "num": "write the number alone; it is grouped and gets the decimal sign of the language",
    "ang": r"write 30^\circ",
    "euro": r"write \text{€}",
    "substack": "write one condition below the sign, and the others in words",
    "widetilde": r"write \tilde{x}",
    "bm": r"write \boldsymbol{x}",
    **dict.fromkeys(("mbox", "textrm", "textbf", "textit", "texttt"), r"write \text{words}"),
    **dict.fromkeys(("tag", "label", "ref", "eqref"), _NUMBERED),
    **dict.fromkeys(("color", "textcolor", "colorbox", "definecolor"), _COLOUR),
    **dict.fromkeys(
        ("def", "gdef", "let", "newcommand", "renewcommand", "providecommand"), _OWN_COMMANDS
    ),
    **dict.fromkeys(("href", "url", "html"), "pages are written by quizgen alone"),
}
"""Commands that authors try, and what to write instead."""

GROUPS: dict[str, tuple[str, ...]] = {
    "fractions and roots": (
        r"\frac{a}{b}", r"\dfrac{a}{b}", r"\tfrac{a}{b}", r"\binom{n}{k}", r"\sqrt{x}",
        r"\sqrt[3]{x}",
    ),
    "scripts and primes": ("x_i", "x^2", "x_{i,j}^{n+1}", "f'", r"A^\top", r"25^\circ"),
    "sums, integrals and limits": (
        *(rf"\{command}_{{i=1}}^n x" for command in LARGE.values()),
        r"\lim_{x \to 0} f(x)", r"\max_i a_i", r"\min_i a_i", r"\sup_i a_i", r"\inf_i a_i",
    ),
    "functions": (
        *(rf"\{name} x" for name in (
            "sin", "cos", "tan", "cot", "sec", "csc", "sinh", "cosh", "tanh", "arcsin", "arccos",
            "arctan", "ln", "log", "lg", "exp", "det", "dim", "ker", "arg", "deg", "gcd", "Pr",
        )),
        r"\operatorname{Var}(X)", r"\operatorname*{arg\,max}_x f(x)",
    ),
    "accents": (
        r"\bar{x}", r"\hat{p}", r"\tilde{x}", r"\vec{v}", r"\dot{x}", r"\ddot{x}", r"\check{x}",
        r"\breve{x}", r"\mathring{x}", r"\widehat{ab}", r"\overline{AB}", r"\underline{x}",
        r"\overrightarrow{AB}",
    ),
    "above and below": (
        r"\underbrace{a + b}_{n}", r"\overbrace{a + b}^{n}", r"\overset{!}{=}",
        r"\stackrel{d}{\to}", r"\underset{x}{y}", r"\xrightarrow{f}",
    ),
    "brackets": (
        r"\left( x \right)", r"\left[ x \right)", r"\{x\}", r"|x|", r"\lVert x \rVert", r"\|x\|",
        r"\lfloor x \rfloor", r"\lceil x \rceil", r"\langle x, y \rangle",
        r"\left. f \right|_{x=0}", r"\bigl( x \bigr)", r"\Bigl( x \Bigr)",
    ),
    "environments": (
        *(
            rf"\begin{{{name}}}{'{cc}' * (name == 'array')} a & b \\ c & d \end{{{name}}}"
            for name in ENVIRONMENTS
            if name != "gathered"
        ),
        r"\begin{gathered} a \\ b \end{gathered}",
    ),
    "letters": (
        *(rf"\{name}" for name in GREEK if name not in {"lamda", "epsilon"}),
        *(rf"\{name}" for name in LETTERLIKE.values()), r"\varepsilon", r"\varphi",
    ),
    "alphabets": (
        r"\mathbb{R}", r"\mathcal{L}", r"\mathfrak{g}", r"\mathsf{A}", r"\mathtt{x}",
        r"\mathbf{x}", r"\boldsymbol{\beta}", r"\mathrm{d}x", r"\text{if } x",
    ),
    "relations": (
        *(rf"a \{name} b" for name in ("ne", "neq", "le", "leq", "ge", "geq", "approx", "propto",
                                       "in", "sim", "ll", "gg", "mid")),
        *(rf"a \{name} b" for name in RELATIONS.values() if name != ":="), "a := b",
    ),
    "arrows": (
        *(rf"a \{name} b" for name in ("to", "rightarrow", "Rightarrow")),
        *(rf"a \{name} b" for name in ARROWS.values()),
    ),
    "operators": (
        *(rf"a \{name} b" for name in ("cdot", "times", "pm", "bmod", "vee", "wedge")),
        *(rf"a \{name} b" for name in BINARY.values()), "n!", r"50\,\%",
    ),
    "logic and dots": (*(rf"\{name} a" for name in PLAIN.values()), r"\dots", r"\ldots"),
    "blanks": (r"a\,b", r"a\:b", r"a\;b", r"a\ b", r"a~b", r"a\quad b", r"a\qquad b", r"a\!b",
               r"f\colon A"),
}  # fmt: skip
"""What there is, by kind, each as an example that every output can say."""

COMMANDS = tuple(
    sorted(
        {
            name
            for examples in GROUPS.values()
            for example in examples
            for name in re.findall(r"\\([A-Za-z]+)", example)
        }
    )
)
"""Names of all commands there are."""
