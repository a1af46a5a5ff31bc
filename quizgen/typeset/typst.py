"""Typst mathematics, without the dollar signs.

Letters are separated by spaces (two together would be an unknown variable), commas and slashes
that are meant as such are escaped, and primes stand before subscripts.
"""

from __future__ import annotations

from functools import lru_cache, singledispatch

from quizgen.core.errors import RenderError
from quizgen.locale import localise_numbers
from quizgen.typeset import nodes as n
from quizgen.typeset.names import KNOWN
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
    GAPS,
    LARGE,
    SIGN_COMMANDS,
)

_known = strict_lookup("Typst")

_OPERATORS = {
    "": "",
    " ": "thin",
    "neg": "-",
    "pos": "+",
    "·": "dot.op",
    "/": "slash",
    ",": r"\,",
    ";": r"\;",
    "~": "tilde.op",
    "mod": "mod",
    "′": "prime",
    "|": "divides",
    "ᵀ": 'upright("T")',
    ":": "colon",
    **{same: same for same in "+-=≠<≤>≥≈∝→⇒∈±≪≫×…"},
    "such that": "divides",
    "divides": "divides",
    "colon": 'class("punctuation", colon)',
    "apply": "",
    "apply tight": "",
    "!": "!",
    "?": "?",
    ".": ".",
    "°": "degree",
    "%": "%",
}
_OPERATORS |= {sign: sign for sign in SIGN_COMMANDS if sign not in _OPERATORS}
_BRACKETS = {
    "(": "paren.l",
    ")": "paren.r",
    "[": "bracket.l",
    "]": "bracket.r",
    "{": "brace.l",
    "}": "brace.r",
    **{sign: f"\\{sign}" for sign in "|‖⌊⌋⌈⌉⟨⟩"},
    ".": "",
}
_CALLS = {"||": "abs", "⌊⌋": "floor", "⌈⌉": "ceil", "‖‖": "norm"}
_UNITS = {"e⁻": '"e"^(-)'}
_SIGNS = {sign: sign for sign in LARGE} | {"∑": "sum", "∏": "product", "∫": "integral"}


def to_typst(node: n.Node, lang: str = "en") -> str:
    """Return a layout as Typst mathematics.

    Parameters
    ----------
    node : Node
        The layout.
    lang : str
        Language of words such as *otherwise*.

    Raises
    ------
    RenderError
        If the layout holds something that has no Typst form.
    """
    return _format_node(node, lang)


def typst_string(text: str) -> str:
    r"""Return a Typst string literal.

    Examples
    --------
    >>> typst_string('a "b"')
    '"a \\"b\\""'
    """
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


@singledispatch
def _format_node(node: n.Node, lang: str) -> str:
    """Return a node in Typst; each kind of node registers its own function.

    Raises
    ------
    RenderError
        For a kind that has none.
    """
    raise RenderError(f"no Typst for {type(node).__name__} ({lang})")


@_format_node.register
def _format_digits(node: n.Digits, lang: str) -> str:
    """Return digits with the signs of a language."""
    text = localise_numbers(lang, node.text).replace(" ", "\u202f")
    return text if text.replace(".", "", 1).isdigit() and text.isascii() else typst_string(text)


@_format_node.register
def _format_letter(node: n.Ident, _lang: str) -> str:
    """Return a letter, bold if it stands for a vector or matrix."""
    if node.style:
        return f"{_known(ALPHABETS, node.style, 'alphabet').typst}({node.text})"
    return f"upright(bold({node.text}))" if node.bold else node.text


@_format_node.register
def _format_word(node: n.Word, _lang: str) -> str:
    """Return a name of several letters, upright."""
    return typst_string(node.text)


@_format_node.register
def _format_phrase(node: n.Phrase, _lang: str) -> str:
    """Return a phrase of the author as a string."""
    return typst_string(node.text)


@_format_node.register
def _format_function_name(node: n.FunctionName, lang: str) -> str:
    """Return the name of a function in upright letters."""
    return _format_function_head(n.Word(node.text), lang)


@_format_node.register
def _format_gap(node: n.Gap, _lang: str) -> str:
    """Return a gap, in em."""
    return f"#h({_known(GAPS, node.width, 'gap'):.2f}em)"


@_format_node.register
def _format_reader_word(node: n.ReaderWord, lang: str) -> str:
    """Return a word between formulas, such as *and*, with blanks around it."""
    return typst_string(f" {_known(load_speech_words(lang).printed, node.key, 'word')} ")


@lru_cache(maxsize=512)
def _unit_text(text: str) -> str:
    """Return a unit in Typst, cached since a paper repeats it."""
    written = ""
    for part in split_unit(text):
        sign = {"·": "dot.op", "/": "slash", "": ""}[part.sign]
        power = f"^({part.power})" if part.power else ""
        opening, closing = (
            typst_string(one) if one else "" for one in (part.opening, part.closing)
        )
        simple = _UNITS.get(part.shown) or typst_string(part.shown)
        written += f"{sign}{opening}{simple}{power}{closing}"
    return written


@_format_node.register
def _format_unit(node: n.UnitText, _lang: str) -> str:
    """Return a unit that stands alone."""
    return _unit_text(node.text)


@_format_node.register
def _format_quantity(node: n.NumberWithUnit, lang: str) -> str:
    """Return a number with its unit, a thin space between them unless the unit has none."""
    space = "" if node.unit.text in TIGHT else " thin"
    return f"{_format_node(node.value, lang)}{space}{_unit_text(node.unit.text)}"


@_format_node.register
def _format_operator(node: n.OperatorSign, _lang: str) -> str:
    """Return an operator's sign; RenderError if there is none."""
    return _known(_OPERATORS, node.name, "operator")


@_format_node.register
def _format_row(node: n.MathRow, lang: str) -> str:
    """Return the items of a row one after the other."""
    if not node.items:
        return '""'  # an argument must be something
    return _join_with_spaces(
        [_format_node(item, lang) for item in insert_separators(node.items, lang)]
    )


def _join_with_spaces(texts: list[str]) -> str:
    """Return texts with spaces between, except next to a string, where Typst prints the space."""
    written = ""
    for text in texts:
        tight = not written or not text or written[-1] == '"' or text[0] == '"'
        written += text if tight else " " + text
    return written


@_format_node.register
def _format_fraction(node: n.Frac, lang: str) -> str:
    """Return a fraction with a bar, or with a slash within a line."""
    top, bottom = _format_node(node.top, lang), _format_node(node.bottom, lang)
    if node.inline:
        return _join_with_spaces([top, "slash", bottom])
    return f"frac({top}, {bottom})"


@_format_node.register
def _format_root(node: n.Root, lang: str) -> str:
    """Return a root, with its index unless it is a square root."""
    body = _format_node(node.body, lang)
    return f"root({_format_node(node.index, lang)}, {body})" if node.index else f"sqrt({body})"


@_format_node.register
def _format_scripts(node: n.Scripts, lang: str) -> str:
    """Return a base with primes, subscript and superscript."""
    written = _format_node(node.base, lang) + "'" * node.primes
    if node.sub is not None:
        written += f"_({_format_node(node.sub, lang)})"
    if node.sup is not None:
        written += f"^({_format_node(node.sup, lang)})"
    return written


@_format_node.register
def _format_accent(node: n.Accent, lang: str) -> str:
    """Return a letter with its accent; RenderError if there is none."""
    return f"{_known(ACCENTS, node.kind, 'accent').typst}({_format_node(node.base, lang)})"


@_format_node.register
def _format_fence(node: n.Fenced, lang: str) -> str:
    """Return brackets around a node, as tall as it is."""
    body = _format_node(node.body, lang)
    if node.kind == "()":
        return f"({body})"
    if node.kind in _CALLS:
        return f"{_CALLS[node.kind]}({body})"
    left, right = (_known(_BRACKETS, bracket, "bracket") for bracket in node.kind)
    return f"lr({left} {body} {right})".replace("  ", " ").replace("( ", "(").replace(" )", ")")


@_format_node.register
def _format_function(node: n.Func, lang: str) -> str:
    """Return a function with its arguments in brackets, separated as a language does."""
    between = f" {_OPERATORS[list_separator(node.args, lang).name]} "
    arguments = between.join([_format_node(arg, lang) for arg in node.args])
    return f"{_format_function_head(node.head, lang)} ({arguments})"


def _format_function_head(node: n.Node, lang: str) -> str:
    """Return a function's name, or an operator of that name if Typst has none."""
    if isinstance(node, n.Word):
        return node.text if node.text in KNOWN else f"op({typst_string(node.text)})"
    if isinstance(node, n.FunctionName):
        return _format_function_head(n.Word(node.text), lang)
    if isinstance(node, n.Scripts):
        return _format_function_head(node.base, lang) + _format_scripts(node.alone, lang)
    return _format_node(node, lang)


@_format_node.register
def _format_large_operator(node: n.LargeOperator, lang: str) -> str:
    """Return a sum, product or integral sign with its bounds."""
    return _known(_SIGNS, node.sign, "sign") + _format_scripts(node.bounds, lang)


@_format_node.register
def _format_under(node: n.Under, lang: str) -> str:
    """Return a node with another one below it."""
    base = _format_function_head(node.base, lang)
    if isinstance(node.base, n.Word | n.FunctionName):
        return f"limits({base})_({_format_node(node.below, lang)})"
    return f"attach({base}, b: {_format_node(node.below, lang)})"


@_format_node.register
def _format_over(node: n.Over, lang: str) -> str:
    """Return a sign with another above it."""
    return f"attach({_format_node(node.base, lang)}, t: {_format_node(node.above, lang)})"


@_format_node.register
def _format_brace(node: n.Brace, lang: str) -> str:
    """Return a body with a curly brace above or below it and, at the brace, its note."""
    note = f", {_format_node(node.note, lang)}" if node.note else ""
    return f"{'over' if node.upside else 'under'}brace({_format_node(node.body, lang)}{note})"


@_format_node.register
def _format_display(node: n.Display, lang: str) -> str:
    """Return a body as large as in a formula on a line of its own."""
    return f"display({_format_node(node.body, lang)})"


@_format_node.register
def _format_binomial(node: n.Binomial, lang: str) -> str:
    """Return a binomial coefficient."""
    return f"binom({_format_node(node.top, lang)}, {_format_node(node.bottom, lang)})"


@_format_node.register
def _format_cases(node: n.Cases, lang: str) -> str:
    """Return branches after a brace, the last one with the word for *otherwise*."""
    rows = []
    for value, condition in node.rows:
        when = typst_string(load_speech_words(lang).printed["otherwise"])
        if condition is not None:
            when = _format_case_condition(_format_node(condition, lang), lang)
        rows.append(f"{_format_node(value, lang)} quad & {when}")
    return "cases(" + ", ".join(rows) + ")"


def _format_case_condition(condition: str, lang: str) -> str:
    """Return a condition between the words that a language has for *if*."""
    before, after = (half.strip() for half in load_speech_words(lang).printed["if"].split("{}"))
    left = typst_string(f"{before} ") if before else ""
    return left + condition + (typst_string(f" {after}") if after else "")


@_format_node.register
def _format_matrix(node: n.Matrix, lang: str) -> str:
    """Return a matrix in round brackets."""
    rows = [", ".join([_format_node(cell, lang) for cell in row]) for row in node.rows]
    # in a line of text Typst would set the cells as small as in a fraction
    return f"display(mat({_known(_DELIMITERS, node.kind, 'matrix')}" + "; ".join(rows) + "))"


_DELIMITERS = {
    "": "delim: #none, ", "()": "", "[]": 'delim: "[", ', "{}": 'delim: "{", ',
    "||": 'delim: "|", ', "‖‖": 'delim: "‖", ',
}  # fmt: skip


@_format_node.register
def _format_aligned_rows(node: n.AlignedRows, lang: str) -> str:
    """Return aligned rows, after a brace if they are cases."""
    cells = [[_format_node(cell, lang) for cell in row] for row in node.rows]
    if node.brace:
        return "display(cases(" + ", ".join([" quad & ".join(row) for row in cells]) + "))"
    rows = [" & ".join(row) for row in cells]
    return "display(mat(delim: #none, row-gap: #0.5em, " + "; ".join(rows) + "))"
