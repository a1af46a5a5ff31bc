"""Formulas in plain Unicode on one line, for terminals and wherever else nothing can be typeset.

What Unicode has no sign for is written so that it can be read in one way only: ``(a + b)/c``,
``x^(n+1)``, ``√(x + 1)``. The digits and signs are those of ``maths.notation.pretty``.
"""

from __future__ import annotations

import re
import unicodedata
from functools import singledispatch

from quizgen.core.errors import RenderError
from quizgen.locale import localise_numbers
from quizgen.maths.notation import pretty
from quizgen.maths.units import format_unit
from quizgen.typeset import nodes as n
from quizgen.typeset.printer import (
    TIGHT,
    insert_separators,
    list_separator,
    load_speech_words,
    strict_lookup,
)
from quizgen.typeset.signs import ACCENTS, INTEGRALS, LARGE, SIGN_COMMANDS, find_styled_letter

_SPACES = re.compile("  +")
_known = strict_lookup("text")

_BELOW = pretty.TO_BELOW | str.maketrans("=−()", "₌₋₍₎")
_ABOVE = pretty.RAISED | str.maketrans("−ni", "⁻ⁿⁱ")
_TIGHT = {
    "": "·", "·": "·", "neg": "−", "pos": "+", "∃!": "∃!", "/": "/", "′": "′", "!": "!",
    "?": "?", "°": "°", "%": "%",
    ".": ".", "¬": "¬", "∘": "∘", "∀": "∀", "∃": "∃", "∄": "∄", "ᵀ": "ᵀ", "†": "†", "…": "…",
    "⋯": "⋯", "⋮": "⋮", "⋱": "⋱", "apply": " ", "apply tight": "", " ": " ", ",": ", ", ";": "; ",
    "colon": ": ", "∠": "∠",
}  # fmt: skip
"""Signs without blanks around, or with a blank behind."""
_SPACED = {
    "-": "−", "mod": "mod", "~": "~", "|": "|", "such that": "|", "divides": "|", ":": ":",
    "≔": ":=", **{same: same for same in "+=≠<≤>≥≈∝→⇒∈±≪≫×"},
} | {sign: sign for sign in SIGN_COMMANDS}  # fmt: skip


def to_text(node: n.Node, lang: str = "en") -> str:
    r"""Return a layout as plain text.

    Parameters
    ----------
    node : Node
        The layout.
    lang : str
        Language of words and of the decimal sign.

    Raises
    ------
    RenderError
        If the layout holds something that has no plain text.

    Examples
    --------
    >>> from quizgen.typeset.from_latex import lay_out_latex
    >>> to_text(lay_out_latex(r"s^2 = \frac{1}{n-1}\sum_{i=1}^n (x_i - \bar x)^2"))
    's² = 1/(n − 1) ∑ᵢ₌₁ⁿ (xᵢ − x̄)²'
    """
    return _SPACES.sub(" ", unicodedata.normalize("NFC", _format_node(node, lang))).strip()


@singledispatch
def _format_node(node: n.Node, lang: str) -> str:
    """Return a node as text in a language; ``RenderError`` if no function is registered for it."""
    raise RenderError(f"no text for {type(node).__name__} ({lang})")


@_format_node.register
def _format_digits(node: n.Digits, lang: str) -> str:
    """Return a number with the digits and the decimal sign of the language."""
    return localise_numbers(lang, node.text)


@_format_node.register
def _format_letter(node: n.Ident, _lang: str) -> str:
    """Return a letter, in its style where Unicode has one."""
    return find_styled_letter(node.text, node.style) if node.style else node.text


@_format_node.register
def _format_word(node: n.Word | n.Phrase | n.FunctionName, _lang: str) -> str:
    """Return a word, a phrase or the name of a function as it is."""
    return node.text


@_format_node.register
def _format_gap(_node: n.Gap, _lang: str) -> str:
    """Return one blank, however wide the gap."""
    return " "


@_format_node.register
def _format_reader_word(node: n.ReaderWord, lang: str) -> str:
    """Return a word that belongs to the language, between blanks."""
    return f" {_known(load_speech_words(lang).printed, node.key, 'word')} "


@_format_node.register
def _format_unit(node: n.UnitText, _lang: str) -> str:
    """Return a unit."""
    return format_unit(node.text)


@_format_node.register
def _format_quantity(node: n.NumberWithUnit, lang: str) -> str:
    """Return a number with its unit, which does not go to a new line without it."""
    space = "" if node.unit.text in TIGHT else "\u00a0"
    return f"{_format_node(node.value, lang)}{space}{format_unit(node.unit.text)}"


@_format_node.register
def _format_operator(node: n.OperatorSign, _lang: str) -> str:
    """Return a sign, with blanks around it unless it binds tightly."""
    if node.name in _TIGHT:
        return _TIGHT[node.name]
    return f" {_known(_SPACED, node.name, 'operator')} "


@_format_node.register
def _format_row(node: n.MathRow, lang: str) -> str:
    """Return the items of a row one after the other, with single blanks where they would merge."""
    items = insert_separators(node.items, lang)
    written = ""
    for at, item in enumerate(items):
        text = _format_node(item, lang)
        before = items[at - 1] if at else None
        if before is not None and _has_blank_between(before, item):
            written += " "
        written += text.lstrip() if written.endswith(" ") else text
    return written


_BESIDE = (n.OperatorSign, n.Gap, n.Phrase)


def _has_blank_between(before: n.Node, after: n.Node) -> bool:
    """Whether two neighbours would run into each other."""
    if isinstance(before, _BESIDE) or isinstance(after, _BESIDE):
        return False
    last, first = _find_last(before), _find_first(after)
    return (
        isinstance(last, (*_WIDE, n.Binomial))
        or isinstance(first, _WIDE)
        or (_is_long_word(last) or _is_long_word(first))
    )


_WIDE = (n.FunctionName, n.LargeOperator, n.Under, n.Frac, n.Display, n.Func)


def _is_long_word(node: n.Node) -> bool:
    """Return whether a node is a word of more than one letter."""
    return isinstance(node, n.Word) and len(node.text) > 1


def _find_first(node: n.Node) -> n.Node:
    """Return the node that a row begins with, without its scripts."""
    while isinstance(node, n.Scripts | n.MathRow) and node != n.MathRow(()):
        node = node.base if isinstance(node, n.Scripts) else node.items[0]
    return node


def _find_last(node: n.Node) -> n.Node:
    """Return the node that a row ends with, without its scripts."""
    while isinstance(node, n.Scripts | n.MathRow) and node != n.MathRow(()):
        node = node.base if isinstance(node, n.Scripts) else node.items[-1]
    return node


def _wrap_in_brackets(node: n.Node, lang: str) -> str:
    """Return a node as one thing: in brackets if it has several parts."""
    text = _format_node(node, lang)
    return text if _is_single_term(node) else f"({text})"


def _is_single_term(node: n.Node) -> bool:
    """Return whether a node needs no brackets in a fraction, a script or the like."""
    match node:
        case n.MathRow(items=items):
            return len(items) == 1 and _is_single_term(items[0])
        case (
            n.Frac()
            | n.NumberWithUnit()
            | n.LargeOperator()
            | n.Cases()
            | n.AlignedRows()
            | n.Brace()
            | n.Phrase()
        ):
            return False
        case n.Display(body=body):
            return _is_single_term(body)
    return True


def _is_product(node: n.Node) -> bool:
    """Whether a node can stand above a slash: one thing, or factors that are."""
    if isinstance(node, n.MathRow) and node.level in {n.PRODUCT, n.NEGATIVE, n.ATOM}:
        return not any(isinstance(item, n.LargeOperator | n.Frac | n.Phrase) for item in node.items)
    return _is_single_term(node)


@_format_node.register
def _format_fraction(node: n.Frac, lang: str) -> str:
    """Return a fraction on one line, with brackets around sums."""
    top = (
        _format_node(node.top, lang) if _is_product(node.top) else _wrap_in_brackets(node.top, lang)
    )
    return f"{top}/{_wrap_in_brackets(node.bottom, lang)}"


@_format_node.register
def _format_root(node: n.Root, lang: str) -> str:
    """Return a root, with its index in front of it in small digits."""
    index = "" if node.index is None else _raise(node.index, lang).removeprefix("^")
    text = _format_node(node.body, lang)
    alone = isinstance(node.body, n.Digits | n.Ident)
    return f"{index}√{text if alone else f'({text})'}"


@_format_node.register
def _format_scripts(node: n.Scripts, lang: str) -> str:
    """Return a base with its primes, its index below and its exponent above."""
    base = _format_node(node.base, lang)
    if isinstance(node.base, n.Frac | n.MathRow | n.NumberWithUnit | n.Display | n.Brace):
        base = f"({base})"
    low = "" if node.sub is None else _lower(node.sub, lang)
    high = "" if node.sup is None else _raise(node.sup, lang)
    return f"{base}{'′' * node.primes}{low}{high}"


def _lower(node: n.Node, lang: str) -> str:
    """Return an index in small signs if Unicode has all of them, else after ``_``."""
    text = _format_node(node, lang)
    compact = text.replace(" ", "")
    if all(ord(char) in _BELOW for char in compact):
        return compact.translate(_BELOW)
    return f"_{text}" if len(text) == 1 or text.isalpha() else f"_({text})"


def _raise(node: n.Node, lang: str) -> str:
    """Return an exponent in small signs if Unicode has all of them, else after ``^``."""
    if isinstance(node, n.OperatorSign) and node.name in {"ᵀ", "†", "∗", "+", "-", "neg"}:
        return {"+": "⁺", "-": "⁻", "neg": "⁻", "∗": "*"}.get(node.name, node.name)
    text = _format_node(node, lang)
    compact = text.replace(" ", "")
    if all(ord(char) in _ABOVE for char in compact):
        return compact.translate(_ABOVE)
    return f"^{text}" if _is_single_term(node) and len(text) == 1 else f"^({text})"


@_format_node.register
def _format_accent(node: n.Accent, lang: str) -> str:
    """Return a base with its accent as a combining sign.

    Such a sign covers one letter: over several, a line is repeated for each, and any other accent
    is
    written as a function.
    """
    mark = _known(ACCENTS, node.kind, "accent").combining
    text = _format_node(node.base, lang)
    letters = [char for char in text if not unicodedata.combining(char)]
    if node.kind not in {"overline", "underline"} and len(letters) > 1:
        return f"{node.kind.removeprefix('wide')}({text})"
    if node.kind == "overline" and len(text) == 1:
        mark = ACCENTS["bar"].combining
    if len(letters) == 1:
        return text + mark
    return "".join([char + mark if char != " " else char for char in text])


@_format_node.register
def _format_fence(node: n.Fenced, lang: str) -> str:
    """Return a body between its brackets; a missing bracket is left out."""
    left, right = (sign.replace(".", "") for sign in node.kind)
    return f"{left}{_format_node(node.body, lang).strip()}{right}"


@_format_node.register
def _format_function(node: n.Func, lang: str) -> str:
    """Return a function with its arguments in brackets."""
    between = f"{list_separator(node.args, lang).name} "
    arguments = between.join([_format_node(arg, lang) for arg in node.args])
    return f"{_format_node(node.head, lang)}({arguments})"


@_format_node.register
def _format_binomial(node: n.Binomial, lang: str) -> str:
    """Return a binomial coefficient as ``C(n, k)``."""
    return f"C({_format_node(node.top, lang)}, {_format_node(node.bottom, lang)})"


@_format_node.register
def _format_large_operator(node: n.LargeOperator, lang: str) -> str:
    """Return the sign of a sum, a product or an integral with its bounds."""
    sign = _known({one: one for one in LARGE}, node.sign, "sign")
    if node.sign in INTEGRALS and node.lower and node.upper:
        return f"{sign}[{_format_node(node.lower, lang)}…{_format_node(node.upper, lang)}]"
    return _format_scripts(n.Scripts(n.Word(sign), node.lower, node.upper), lang)


@_format_node.register
def _format_under(node: n.Under, lang: str) -> str:
    """Return a sign with what stands below it as an index."""
    return f"{_format_node(node.base, lang).strip()}_({_format_node(node.below, lang)})"


@_format_node.register
def _format_over(node: n.Over, lang: str) -> str:
    """Return a sign with what stands above it as an exponent."""
    base = _format_node(node.base, lang)
    own = f"{base.strip()}^({_format_node(node.above, lang)})"
    return f" {own} " if base.startswith(" ") else own


@_format_node.register
def _format_brace(node: n.Brace, lang: str) -> str:
    """Return a body in brackets, with the note of its brace after it."""
    note = f" [{_format_node(node.note, lang)}]" if node.note else ""
    return f"{_wrap_in_brackets(node.body, lang)}{note}"


@_format_node.register
def _format_display(node: n.Display, lang: str) -> str:
    """Return a body; its size is the same on one line."""
    return _format_node(node.body, lang)


@_format_node.register
def _format_cases(node: n.Cases, lang: str) -> str:
    """Return cases on one line, each value with its condition."""
    printed = load_speech_words(lang).printed
    rows = [
        f"{_format_node(value, lang)} {printed['otherwise']}"
        if condition is None
        else f"{_format_node(value, lang)} {printed['if'].format(_format_node(condition, lang))}"
        for value, condition in node.rows
    ]
    return f"{{{'; '.join(rows)}"


@_format_node.register
def _format_matrix(node: n.Matrix, lang: str) -> str:
    """Return a matrix on one line, with a semicolon after each row."""
    rows = [", ".join([_format_node(cell, lang) for cell in row]) for row in node.rows]
    kind = node.kind or "[]"
    return f"{kind[0]}{'; '.join(rows)}{kind[-1]}"


@_format_node.register
def _format_aligned_rows(node: n.AlignedRows, lang: str) -> str:
    """Return rows on one line, with a semicolon after each."""
    rows = [[_format_node(cell, lang) for cell in row] for row in node.rows]
    if node.brace:
        return "{" + "; ".join([", ".join([cell.strip(", ") for cell in row]) for row in rows])
    return "; ".join(["".join(row).strip() for row in rows])
