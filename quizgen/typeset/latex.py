"""LaTeX for LaTeX with amsmath, MathJax (Anki, Moodle) and KaTeX.

Two closing braces never touch, because Anki would read them as the end of a cloze. ``<`` and ``&``
are left as they are: the caller that puts the result into HTML escapes it.
"""

from __future__ import annotations

import re
from functools import lru_cache, singledispatch

from quizgen.core.errors import RenderError
from quizgen.locale import localise_numbers
from quizgen.typeset import nodes as n
from quizgen.typeset.names import GREEK, KNOWN
from quizgen.typeset.printer import (
    TIGHT,
    insert_separators,
    list_separator,
    load_speech_words,
    split_unit,
    strict_lookup,
)
from quizgen.typeset.signs import (
    ACCENTS,
    ALPHABETS,
    FENCES,
    LARGE,
    LETTERLIKE,
    SIGN_COMMANDS,
)

_known = strict_lookup("LaTeX")

_LETTERS = {char: "\\" + word for word, char in GREEK.items() if word != "lamda"}
_LETTERS |= {char: "\\" + word for char, word in LETTERLIKE.items()}
_LETTERS |= {"ε": r"\varepsilon", "φ": r"\varphi"}
_OPERATORS = {
    "": "",
    " ": r"\,",
    "neg": "-",
    "pos": "+",
    "·": r"\cdot",
    "×": r"\times",
    "≠": r"\neq",
    "≤": r"\leq",
    "≥": r"\geq",
    "≈": r"\approx",
    "∝": r"\propto",
    "→": r"\to",
    "⇒": r"\Rightarrow",
    "∈": r"\in",
    "±": r"\pm",
    "~": r"\sim",
    "≪": r"\ll",
    "≫": r"\gg",
    "mod": r"\bmod",
    "′": "'",
    "…": r"\dots",
    ",": ",",
    ";": ";",
    "|": r"\mid",
    "ᵀ": r"\mathsf{T}",
    **{same: same for same in "+-=<>/:!?."},
    "such that": r"\mid",
    "divides": r"\mid",
    "colon": r"\colon",
    "apply": "",
    "apply tight": "",
    "°": r"^{\circ}",
    "%": r"\%",
}
_OPERATORS |= {sign: text for sign, text in SIGN_COMMANDS.items() if sign not in _OPERATORS}
_GAPS = {"thin": r"\,", "medium": r"\:", "thick": r"\;", "quad": r"\quad", "qquad": r"\qquad"}
_TALL = re.compile(rf"\\(?:[dt]?frac|binom|begin|{'|'.join(LARGE.values())})\b")
_TOUCHING = re.compile(r"\}(?=\})")
_SPECIAL = re.compile(r"([%#&_${}])")
_NO_TEXT = re.compile(r"([\\^~])")
_AS_SIGN = {"\\": r"\backslash", "^": r"{\wedge}", "~": r"{\sim}"}


def to_latex(node: n.Node, lang: str = "en") -> str:
    r"""Return a layout as LaTeX mathematics, without delimiters.

    Parameters
    ----------
    node : Node
        The layout.
    lang : str
        Language of words such as *otherwise*.

    Raises
    ------
    RenderError
        If the layout holds something that has no LaTeX form.

    Examples
    --------
    >>> from quizgen.typeset import lay_out_name, to_latex
    >>> to_latex(lay_out_name("p'_x"))
    "p'_{x}"
    """
    return _TOUCHING.sub("} ", _format_node(node, lang))


@singledispatch
def _format_node(node: n.Node, lang: str) -> str:
    """Return a node in LaTeX; each kind of node registers its own function.

    Raises
    ------
    RenderError
        For a kind that has none.
    """
    raise RenderError(f"no LaTeX for {type(node).__name__} ({lang})")


@_format_node.register
def _format_digits(node: n.Digits, lang: str) -> str:
    """Return digits with the signs of a language."""
    text = localise_numbers(lang, node.text).replace(",", "{,}")  # no blank behind a decimal comma
    return re.sub(r"\s", r"\\,", text)


@_format_node.register
def _format_letter(node: n.Ident, _lang: str) -> str:
    """Return a letter, bold if it stands for a vector or matrix."""
    letter = _LETTERS.get(node.text, node.text)
    if node.bold:
        return rf"\mathbf{{{letter}}}" if letter.isalnum() else rf"\boldsymbol{{{letter}}}"
    if node.style:
        return f"{_known(ALPHABETS, node.style, 'alphabet').latex}{{{letter}}}"
    return letter


@_format_node.register
def _format_word(node: n.Word, _lang: str) -> str:
    """Return a name of several letters, upright."""
    return rf"\mathrm{{{_escape_latex(node.text)}}}"


@_format_node.register
def _format_phrase(node: n.Phrase, _lang: str) -> str:
    """Return a phrase of the author in text mode, signs that it cannot hold in math mode."""
    parts = _NO_TEXT.split(node.text)  # every other one is a sign that text cannot hold
    written = [
        _AS_SIGN[part] if at % 2 else rf"\text{{{_escape_latex(part)}}}"
        for at, part in enumerate(parts)
        if part
    ]
    return " ".join(written) or "{}"


@_format_node.register
def _format_function_name(node: n.FunctionName, lang: str) -> str:
    """Return the name of a function in upright letters."""
    return _format_function_head(n.Word(node.text), lang)


@_format_node.register
def _format_gap(node: n.Gap, _lang: str) -> str:
    """Return the command of a gap by its width."""
    return _known(_GAPS, node.width, "gap")


def _escape_latex(text: str) -> str:
    """Return a text with LaTeX's special characters escaped."""
    return _SPECIAL.sub(r"\\\1", text)


@_format_node.register
def _format_reader_word(node: n.ReaderWord, lang: str) -> str:
    """Return a word between formulas, such as *and*, with blanks around it."""
    return rf"\text{{ {_known(load_speech_words(lang).printed, node.key, 'word')} }}"


@lru_cache(maxsize=512)
def _unit_text(text: str) -> str:
    """Return a unit in LaTeX, cached since a paper repeats it."""
    written = ""
    for part in split_unit(text):
        sign = r" \cdot " if part.sign == "·" else part.sign
        power = f"^{{{part.power}}}" if part.power else ""
        written += sign + part.opening + _simple_unit(part.shown) + power + part.closing
    return written


def _simple_unit(shown: str) -> str:
    """Return one unit without its power, upright."""
    if shown == "°":
        return r"^{\circ}"
    if shown == "e⁻":
        return r"\mathrm{e}^{-}"
    return rf"\text{{{shown}}}" if "µ" in shown else rf"\mathrm{{{_escape_latex(shown)}}}"


@_format_node.register
def _format_unit(node: n.UnitText, _lang: str) -> str:
    """Return a unit that stands alone."""
    return _unit_text(node.text)


@_format_node.register
def _format_quantity(node: n.NumberWithUnit, lang: str) -> str:
    """Return a number with its unit, a thin space between them unless the unit has none."""
    space = "" if node.unit.text in TIGHT else r"\,"
    return f"{_format_node(node.value, lang)}{space}{_unit_text(node.unit.text)}"


@_format_node.register
def _format_operator(node: n.OperatorSign, _lang: str) -> str:
    """Return an operator's sign; RenderError if there is none."""
    return _known(_OPERATORS, node.name, "operator")


@_format_node.register
def _format_row(node: n.MathRow, lang: str) -> str:
    """Return the items of a row one after the other."""
    return " ".join(
        [text for item in insert_separators(node.items, lang) if (text := _format_node(item, lang))]
    )


@_format_node.register
def _format_fraction(node: n.Frac, lang: str) -> str:
    """Return a fraction with a bar, or with a slash within a line."""
    top, bottom = _format_node(node.top, lang), _format_node(node.bottom, lang)
    return f"{top} / {bottom}" if node.inline else rf"\frac{{{top}}}{{{bottom}}}"


@_format_node.register
def _format_root(node: n.Root, lang: str) -> str:
    """Return a root, with its index unless it is a square root."""
    index = f"[{_format_node(node.index, lang)}]" if node.index else ""
    return rf"\sqrt{index}{{{_format_node(node.body, lang)}}}"


@_format_node.register
def _format_scripts(node: n.Scripts, lang: str) -> str:
    """Return a base with primes, subscript and superscript, in the order that LaTeX needs."""
    low = "" if node.sub is None else f"_{{{_format_node(node.sub, lang)}}}"
    high = "" if node.sup is None else f"^{{{_format_node(node.sup, lang)}}}"
    base = _format_node(node.base, lang)
    if isinstance(node.base, n.Scripts | n.MathRow):  # else its scripts would be two of a kind
        base = f"{{{base}}}"
    if node.primes:  # a prime is a superscript: the exponent must follow it at once
        return base + "'" * node.primes + high + low
    return base + low + high


@_format_node.register
def _format_accent(node: n.Accent, lang: str) -> str:
    """Return a letter with its accent; RenderError if there is none."""
    return f"{_known(ACCENTS, node.kind, 'accent').latex}{{{_format_node(node.base, lang)}}}"


@_format_node.register
def _format_fence(node: n.Fenced, lang: str) -> str:
    """Return brackets around a node, growing with it only if it is tall."""
    body = _format_node(node.body, lang)
    left, right = (_known(FENCES, bracket, "bracket") for bracket in node.kind)
    if _TALL.search(body) or "." in node.kind:
        return rf"\left{left} {body} \right{right}"
    return f"{left}{' ' * left[1:].isalpha()}{body}{' ' * right[1:].isalpha()}{right}"


@_format_node.register
def _format_function(node: n.Func, lang: str) -> str:
    """Return a function with its arguments in brackets, separated as a language does."""
    between = f"{list_separator(node.args, lang).name} "
    arguments = between.join([_format_node(arg, lang) for arg in node.args])
    head = _format_function_head(node.head, lang)
    if _TALL.search(arguments):
        return rf"{head}\!\left( {arguments} \right)"
    return f"{head}({arguments})"


def _format_function_head(node: n.Node, lang: str) -> str:
    """Return a function's name as a command, or as an operator name if LaTeX has none."""
    if isinstance(node, n.Word):
        if node.text in KNOWN:
            return f"\\{node.text}"
        return rf"\operatorname{{{_escape_latex(node.text)}}}".replace(" ", r"\,")
    if isinstance(node, n.FunctionName):
        return _format_function_head(n.Word(node.text), lang)
    if isinstance(node, n.Scripts):
        return _format_function_head(node.base, lang) + _format_scripts(node.alone, lang)
    return _format_node(node, lang)


@_format_node.register
def _format_large_operator(node: n.LargeOperator, lang: str) -> str:
    """Return a sum, product or integral sign with its bounds."""
    return "\\" + _known(LARGE, node.sign, "sign") + _format_scripts(node.bounds, lang)


@_format_node.register
def _format_under(node: n.Under, lang: str) -> str:
    """Return a node with another one below it."""
    if isinstance(node.base, n.Word | n.FunctionName) and node.base.text in KNOWN:
        return f"{_format_function_head(node.base, lang)}_{{{_format_node(node.below, lang)}}}"
    if isinstance(node.base, n.FunctionName):
        name = _format_function_head(node.base, lang).replace(r"\operatorname", r"\operatorname*")
        return f"{name}_{{{_format_node(node.below, lang)}}}"
    return rf"\underset{{{_format_node(node.below, lang)}}}{{{_format_node(node.base, lang)}}}"


@_format_node.register
def _format_over(node: n.Over, lang: str) -> str:
    """Return a sign with another above it."""
    return rf"\overset{{{_format_node(node.above, lang)}}}{{{_format_node(node.base, lang)}}}"


@_format_node.register
def _format_brace(node: n.Brace, lang: str) -> str:
    """Return a body with a curly brace above or below it and, at the brace, its note."""
    command, mark = (r"\overbrace", "^") if node.upside else (r"\underbrace", "_")
    note = f"{mark}{{{_format_node(node.note, lang)}}}" if node.note else ""
    return f"{command}{{{_format_node(node.body, lang)}}}{note}"


@_format_node.register
def _format_display(node: n.Display, lang: str) -> str:
    """Return a body as large as in a formula on a line of its own."""
    return rf"{{\displaystyle {_format_node(node.body, lang)}}}"


@_format_node.register
def _format_binomial(node: n.Binomial, lang: str) -> str:
    """Return a binomial coefficient."""
    return rf"\binom{{{_format_node(node.top, lang)}}}{{{_format_node(node.bottom, lang)}}}"


@_format_node.register
def _format_cases(node: n.Cases, lang: str) -> str:
    """Return branches after a brace, the last one with the word for *otherwise*."""
    rows = []
    for value, condition in node.rows:
        when = r"\text{otherwise}".replace(
            "otherwise", load_speech_words(lang).printed["otherwise"]
        )
        if condition is not None:
            when = _format_case_condition(_format_node(condition, lang), lang)
        rows.append(f"{_format_node(value, lang)} & {when}")
    return r"\begin{cases} " + r" \\ ".join(rows) + r" \end{cases}"


def _format_case_condition(condition: str, lang: str) -> str:
    """Return a condition between the words that a language has for *if*."""
    before, after = load_speech_words(lang).printed["if"].split("{}")
    left = rf"\text{{{before}}} " if before else ""
    return left + condition + (rf" \text{{{after}}}" if after else "")


@_format_node.register
def _format_matrix(node: n.Matrix, lang: str) -> str:
    """Return a matrix in round brackets."""
    rows = [" & ".join([_format_node(cell, lang) for cell in row]) for row in node.rows]
    return _format_environment(_known(_MATRICES, node.kind, "matrix"), rows)


_MATRICES = {
    "": "matrix", "()": "pmatrix", "[]": "bmatrix", "{}": "Bmatrix", "||": "vmatrix",
    "‖‖": "Vmatrix",
}  # fmt: skip


def _format_environment(name: str, rows: list[str]) -> str:
    """Return an environment around its rows."""
    return rf"\begin{{{name}}} " + r" \\ ".join(rows) + rf" \end{{{name}}}"


@_format_node.register
def _format_aligned_rows(node: n.AlignedRows, lang: str) -> str:
    """Return aligned rows: cases after a brace, centred ones if each is a single cell."""
    rows = [" & ".join([_format_node(cell, lang) for cell in row]) for row in node.rows]
    alone = all(len(row) == 1 for row in node.rows)
    return _format_environment("cases" if node.brace else "gathered" if alone else "aligned", rows)
