"""Presentation MathML (Core) for HTML: no JavaScript, about 200 bytes a formula."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache, singledispatch
from html import escape

from quizgen.core.errors import RenderError
from quizgen.locale import localise_numbers
from quizgen.typeset import nodes as n
from quizgen.typeset.names import GREEK_LETTERS
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
    ARROWS,
    FENCES,
    GAPS,
    INTEGRALS,
    LARGE,
    LETTERLIKE,
    SIGN_COMMANDS,
    find_styled_letter,
)

_known = strict_lookup("MathML")

THIN = '<mspace width="0.17em"/>'
_APPLY, _TIMES = "<mo>\u2061</mo>", "<mo>\u2062</mo>"
_OPERATORS = {
    "": _TIMES,
    " ": THIN,
    "neg": '<mo form="prefix">−</mo>',
    "pos": '<mo form="prefix">+</mo>',
    "-": "<mo>−</mo>",
    "·": "<mo>⋅</mo>",
    "mod": '<mo lspace="0.22em" rspace="0.22em">mod</mo>',
    "<": "<mo>&lt;</mo>",
    ">": "<mo>&gt;</mo>",
    "~": "<mo>∼</mo>",
    "/": '<mo lspace="0.1em" rspace="0.1em">/</mo>',
    "→": '<mo stretchy="false">→</mo>',
    "⇒": '<mo stretchy="false">⇒</mo>',
    ",": '<mo separator="true" lspace="0" rspace="0.17em">,</mo>',
    ";": '<mo separator="true" lspace="0" rspace="0.28em">;</mo>',
    "|": '<mo stretchy="false" lspace="0.28em" rspace="0.28em">|</mo>',
    "ᵀ": '<mi mathvariant="normal">T</mi>',
    **{same: f"<mo>{same}</mo>" for same in "+=≠≤≥≈∝∈±≪≫×′…:"},
    "such that": '<mo stretchy="false" lspace="0.28em" rspace="0.28em">|</mo>',
    "divides": "<mo>∣</mo>",
    "colon": '<mo lspace="0" rspace="0.28em">:</mo>',
    "apply": '<mo rspace="0.17em">\u2061</mo>',
    "apply tight": "<mo>\u2061</mo>",
    "!": '<mo form="postfix" lspace="0" rspace="0">!</mo>',
    "?": '<mo form="postfix" lspace="0" rspace="0">?</mo>',
    ".": '<mo separator="true" lspace="0" rspace="0.17em">.</mo>',
    "°": '<mi mathvariant="normal">°</mi>',
    "%": '<mi mathvariant="normal">%</mi>',
    "≔": '<mo lspace="0.28em" rspace="0.28em">≔</mo>',
    "¬": '<mo form="prefix">¬</mo>',
    **{arrow: f'<mo stretchy="false">{arrow}</mo>' for arrow in ARROWS},
}
_OPERATORS |= {sign: f"<mo>{sign}</mo>" for sign in SIGN_COMMANDS if sign not in _OPERATORS}
# A maths font raises its prime by itself: as a superscript it floats above the letter in Chromium,
# and as an operator Firefox takes a form made for superscripts.
_PRIME = "<mtext>′</mtext>"
_PRIME_WIDTH = 0.3
_TIMES_NAMED = '<mo lspace="0" rspace="0.17em">\u2062</mo>'
_BOLD = (
    ("A", 26, 0x1D400), ("a", 26, 0x1D41A), ("Α", 25, 0x1D6A8), ("α", 25, 0x1D6C2),
    ("0", 10, 0x1D7CE),
)  # fmt: skip
_TALL = re.compile(f"<(?:mfrac|msqrt|mroot|mtable|munder|mo>[{''.join(LARGE)}])")


def to_mathml(node: n.Node, lang: str = "en", *, display: bool = False) -> str:
    """Return a layout as a ``<math>`` element.

    Parameters
    ----------
    node : Node
        The layout.
    lang : str
        Language of words such as *otherwise*.
    display : bool
        Set as a block of its own, with big fractions.

    Raises
    ------
    RenderError
        If the layout holds something that has no MathML form.
    """
    start = '<math display="block">' if display else "<math>"
    if isinstance(node, n.MathRow):
        return start + _join_items(node.items, lang) + "</math>"
    return start + _format_node(node, lang) + "</math>"


def _join_items(items: tuple[n.Node, ...], lang: str) -> str:
    """Return the items of a row, with a language's separators and space before functions."""
    items = insert_separators(items, lang)
    written = [_format_node(item, lang) for item in items]
    for index, item in enumerate(items):
        if isinstance(item, n.Func) and isinstance(item.head, n.Word | n.Scripts):
            _widen_before_function(written, index)
        elif index and _is_function_name(item) and not isinstance(items[index - 1], _NO_FACTORS):
            written[index] = THIN + written[index]
        if index and _needs_gap_behind(items[index - 1]) and not isinstance(item, _NO_FACTORS):
            written[index] = THIN + written[index]
    return "".join(written)


def _widen_before_function(written: list[str], index: int) -> None:
    """Put a thin space between a factor and a function's name, in ``written`` itself."""
    if index and written[index - 1] == _TIMES:
        written[index - 1] = _TIMES_NAMED


_NO_FACTORS = (n.OperatorSign, n.Gap, n.Phrase, n.LargeOperator, n.FunctionName)


def _needs_gap_behind(node: n.Node) -> bool:
    """Whether a node is a name with something below it, which no application sign follows."""
    return isinstance(node, n.Under) and isinstance(node.base, n.FunctionName)


def _is_function_name(node: n.Node) -> bool:
    """Whether a node is a name such as ``sin``, maybe with scripts or something below."""
    while isinstance(node, n.Scripts | n.Under):
        node = node.base
    return isinstance(node, n.FunctionName)


@singledispatch
def _format_node(node: n.Node, lang: str) -> str:
    """Return a node in MathML; each kind of node registers its own function.

    Raises
    ------
    RenderError
        For a kind that has none.
    """
    raise RenderError(f"no MathML for {type(node).__name__} ({lang})")


@_format_node.register
def _format_digits(node: n.Digits, lang: str) -> str:
    """Return digits with the signs of a language."""
    return f"<mn>{localise_numbers(lang, node.text).replace(' ', chr(0x202F))}</mn>"


@_format_node.register
def _format_letter(node: n.Ident, _lang: str) -> str:
    """Return a letter, bold if it stands for a vector or matrix."""
    if node.bold:
        return f"<mi>{bold_letter(node.text)}</mi>"
    if node.style:
        return f"<mi>{find_styled_letter(node.text, node.style)}</mi>"
    upright = (node.text in GREEK_LETTERS and node.text.isupper()) or node.text in _UPRIGHT
    return f'<mi mathvariant="normal">{node.text}</mi>' if upright else f"<mi>{node.text}</mi>"


def bold_letter(letter: str) -> str:
    """Return the mathematical bold form of a letter, which maths fonts have even when bold is not.

    Raises
    ------
    RenderError
        If there is none.

    Examples
    --------
    >>> bold_letter("p"), bold_letter("μ")
    ('𝐩', '𝛍')
    """
    for first, count, start in _BOLD:
        if 0 <= ord(letter) - ord(first) < count:
            return chr(start + ord(letter) - ord(first))
    raise RenderError(f"no bold form of {letter!r}")


_UPRIGHT = LETTERLIKE.keys() - {*"ℓϑϕϵϱς∂"}


@_format_node.register
def _format_word(node: n.Word | n.FunctionName, _lang: str) -> str:
    """Return a name of several letters, upright."""
    shape = ' mathvariant="normal"' if len(node.text) == 1 else ""
    return f"<mi{shape}>{escape(node.text)}</mi>"


@_format_node.register
def _format_phrase(node: n.Phrase, _lang: str) -> str:
    """Return a phrase of the author as text, with blanks at its ends that stay."""
    # blanks at the ends of an element are dropped
    text = re.sub("^ | $", "\u00a0", node.text)
    return f"<mtext>{escape(text)}</mtext>" if text else "<mrow></mrow>"


@_format_node.register
def _format_gap(node: n.Gap, _lang: str) -> str:
    """Return a gap, in em."""
    return f'<mspace width="{_known(GAPS, node.width, "gap"):.2f}em"/>'


@_format_node.register
def _format_reader_word(node: n.ReaderWord, lang: str) -> str:
    """Return a word between formulas, such as *and*, with blanks around it."""
    return f"<mtext>\u00a0{_known(load_speech_words(lang).printed, node.key, 'word')}\u00a0</mtext>"


@lru_cache(maxsize=512)
def _unit_text(text: str) -> str:
    """Return a unit in MathML, cached since a paper repeats it."""
    written, plain = "", ""
    for part in split_unit(text):
        plain += part.sign.replace("·", "⋅") + part.opening + part.shown
        if part.power:
            exponent = f"<mn>{part.power.replace('-', '−')}</mn>"
            written += f"<msup><mtext>{plain}</mtext>{exponent}</msup>"
            plain = ""
        plain += part.closing
    tail = f"<mtext>{plain}</mtext>" if plain else ""
    return f"<mrow>{written}{tail}</mrow>" if written and tail else written + tail


@_format_node.register
def _format_unit(node: n.UnitText, _lang: str) -> str:
    """Return a unit that stands alone."""
    return _unit_text(node.text)


@_format_node.register
def _format_quantity(node: n.NumberWithUnit, lang: str) -> str:
    """Return a number with its unit, a thin space between them unless the unit has none."""
    space = "" if node.unit.text in TIGHT else THIN
    return f"<mrow>{_format_node(node.value, lang)}{space}{_unit_text(node.unit.text)}</mrow>"


@_format_node.register
def _format_operator(node: n.OperatorSign, _lang: str) -> str:
    """Return an operator's sign; RenderError if there is none."""
    return _known(_OPERATORS, node.name, "operator")


@_format_node.register
def _format_row(node: n.MathRow, lang: str) -> str:
    """Return the items of a row one after the other."""
    return f"<mrow>{_join_items(node.items, lang)}</mrow>"


@_format_node.register
def _format_fraction(node: n.Frac, lang: str) -> str:
    """Return a fraction with a bar, or with a slash within a line."""
    top, bottom = _format_node(node.top, lang), _format_node(node.bottom, lang)
    if node.inline:
        return f"<mrow>{top}{_OPERATORS['/']}{bottom}</mrow>"
    return f"<mfrac>{top}{bottom}</mfrac>"


@_format_node.register
def _format_root(node: n.Root, lang: str) -> str:
    """Return a root, with its index unless it is a square root."""
    body = _format_node(node.body, lang)
    if node.index is None:
        return f"<msqrt>{body}</msqrt>"
    return f"<mroot>{body}{_format_node(node.index, lang)}</mroot>"


@_format_node.register
def _format_scripts(node: n.Scripts, lang: str) -> str:
    """Return a base with primes, subscript and superscript."""
    base = _format_node(node.base, lang)
    sup = "" if node.sup is None else _format_node(node.sup, lang)
    if node.sub is None:
        primed = f"<mrow>{base}{_PRIME * node.primes}</mrow>" if node.primes else base
        return f"<msup>{primed}{sup}</msup>" if sup else primed
    sub = _format_node(node.sub, lang)
    if node.primes:  # without a width of their own, so that the subscript stands below them
        base = f'<mrow>{base}<mpadded width="0">{_PRIME * node.primes}</mpadded></mrow>'
        sup = sup and f'<mrow><mspace width="{_PRIME_WIDTH * node.primes:.2f}em"/>{sup}</mrow>'
    return f"<msubsup>{base}{sub}{sup}</msubsup>" if sup else f"<msub>{base}{sub}</msub>"


@_format_node.register
def _format_accent(node: n.Accent, lang: str) -> str:
    """Return a letter with its accent; RenderError if there is none."""
    accent = _known(ACCENTS, node.kind, "accent")
    base = _format_node(node.base, lang)
    if accent.below:
        return f'<munder accentunder="true">{base}<mo stretchy="true">{accent.mark}</mo></munder>'
    if accent.stretches:
        return f'<mover accent="true">{base}<mo stretchy="true">{accent.mark}</mo></mover>'
    # the padding keeps Chromium from lowering the mark into the letter
    small = ";font-size:.65em" if accent.mark == "→" else ""
    sign = f'<mo stretchy="false" style="padding-bottom:.07em{small}">{accent.mark}</mo>'
    return f'<mover accent="true">{base}{sign}</mover>'


@_format_node.register
def _format_fence(node: n.Fenced, lang: str) -> str:
    """Return brackets around a node, as tall as it is."""
    return f"<mrow>{_format_brackets(node.kind, _format_inside(node.body, lang))}</mrow>"


def _format_inside(node: n.Node, lang: str) -> str:
    """Return a node for the inside of brackets, without a group of its own."""
    return (
        _join_items(node.items, lang) if isinstance(node, n.MathRow) else _format_node(node, lang)
    )


def _format_brackets(kind: str, body: str) -> str:
    """Return brackets around MathML, stretched only if it is tall.

    Raises
    ------
    RenderError
        If there are no such brackets.
    """
    left, right = kind[0], kind[-1]
    if left not in FENCES or right not in FENCES:
        raise RenderError(f"no MathML for the brackets {kind!r}")
    # stretched to the height of one letter, brackets get loose in Chromium
    stretchy = "true" if _TALL.search(body) or "." in kind else "false"
    opening, closing = (
        "" if sign == "." else f'<mo form="{form}" stretchy="{stretchy}">{sign}</mo>'
        for form, sign in (("prefix", left), ("postfix", right))
    )
    return f"{opening}{body}{closing}"


@_format_node.register
def _format_function(node: n.Func, lang: str) -> str:
    """Return a function with its arguments in brackets, separated as a language does."""
    arguments = _OPERATORS[list_separator(node.args, lang).name].join(
        [_format_inside(arg, lang) for arg in node.args]
    )
    head = _format_node(node.head, lang)
    return f"<mrow>{head}{_APPLY}<mrow>{_format_brackets('()', arguments)}</mrow></mrow>"


@_format_node.register
def _format_large_operator(node: n.LargeOperator, lang: str) -> str:
    """Return a sum, product or integral sign with its bounds."""
    if node.sign not in LARGE:
        raise RenderError(f"no MathML for the sign {node.sign!r}")
    sign = f"<mo>{node.sign}</mo>"
    low, high = (bound and _format_node(bound, lang) for bound in (node.lower, node.upper))
    kind = ("sub", "sup") if node.sign in INTEGRALS else ("under", "over")
    if low and high:
        return f"<m{kind[0]}{kind[1]}>{sign}{low}{high}</m{kind[0]}{kind[1]}>"
    if low or high:
        tag = "m" + (kind[0] if low else kind[1])
        return f"<{tag}>{sign}{low or high}</{tag}>"
    return sign


@_format_node.register
def _format_under(node: n.Under, lang: str) -> str:
    """Return a node with another one below it."""
    return f"<munder>{_format_node(node.base, lang)}{_format_node(node.below, lang)}</munder>"


@_format_node.register
def _format_over(node: n.Over, lang: str) -> str:
    """Return a sign with another above it."""
    return f"<mover>{_format_node(node.base, lang)}{_format_node(node.above, lang)}</mover>"


@_format_node.register
def _format_brace(node: n.Brace, lang: str) -> str:
    """Return a body with a curly brace above or below it and, at the brace, its note."""
    body, note = (part and _format_node(part, lang) for part in (node.body, node.note))
    tag, mark = ("mover", "⏞") if node.upside else ("munder", "⏟")
    braced = f'<{tag}>{body}<mo stretchy="true">{mark}</mo></{tag}>'
    return f"<{tag}>{braced}{note}</{tag}>" if note else braced


@_format_node.register
def _format_display(node: n.Display, lang: str) -> str:
    """Return a body as large as in a formula on a line of its own."""
    return f'<mstyle displaystyle="true">{_format_inside(node.body, lang)}</mstyle>'


@_format_node.register
def _format_binomial(node: n.Binomial, lang: str) -> str:
    """Return a binomial coefficient: a fraction without its line, in brackets."""
    top, bottom = _format_node(node.top, lang), _format_node(node.bottom, lang)
    body = f'<mfrac linethickness="0">{top}{bottom}</mfrac>'
    return f"<mrow>{_format_brackets('()', body)}</mrow>"


@_format_node.register
def _format_cases(node: n.Cases, lang: str) -> str:
    """Return branches after a brace, the last one with the word for *otherwise*."""
    rows = []
    for value, condition in node.rows:
        when = f"<mtext>{load_speech_words(lang).printed['otherwise']}</mtext>"
        if condition is not None:
            when = _format_case_condition(_format_inside(condition, lang), lang)
        rows.append(f"<mtr>{_format_cell(_format_node(value, lang))}{_format_cell(when)}</mtr>")
    brace = '<mo form="prefix" stretchy="true">{</mo>'
    return f"<mrow>{brace}<mtable>{''.join(rows)}</mtable></mrow>"


def _format_cell(body: str) -> str:
    """Return a cell of a table of branches."""
    return f'<mtd style="text-align:left;padding:0.2em 0.4em">{body}</mtd>'


def _format_case_condition(condition: str, lang: str) -> str:
    """Return a condition between the words that a language has for *if*."""
    before, after = (half.strip() for half in load_speech_words(lang).printed["if"].split("{}"))
    left = f"<mtext>{before}\u00a0</mtext>" if before else ""
    return left + condition + (f"<mtext>\u00a0{after}</mtext>" if after else "")


@_format_node.register
def _format_matrix(node: n.Matrix, lang: str) -> str:
    """Return a matrix in round brackets."""
    rows = [
        "<mtr>" + "".join([f"<mtd>{_format_node(cell, lang)}</mtd>" for cell in row]) + "</mtr>"
        for row in node.rows
    ]
    table = f"<mtable>{''.join(rows)}</mtable>"
    return f"<mrow>{_format_brackets(node.kind, table)}</mrow>" if node.kind else table


@_format_node.register
def _format_aligned_rows(node: n.AlignedRows, lang: str) -> str:
    """Return aligned rows as a table, with a brace in front if they are cases."""
    rows = [
        "<mtr>" + "".join(_format_aligned_cells(node, row, lang)) + "</mtr>" for row in node.rows
    ]
    if not node.brace:
        return f'<mtable displaystyle="true">{"".join(rows)}</mtable>'
    brace = '<mo form="prefix" stretchy="true">{</mo>'
    return f"<mrow>{brace}<mtable>{''.join(rows)}</mtable></mrow>"


def _format_aligned_cells(node: n.AlignedRows, row: tuple[n.Node, ...], lang: str) -> Iterator[str]:
    """Yield cells set left after a brace; else right and left in turn, or alone centred."""
    for place, cell in enumerate(row):
        body = _format_inside(cell, lang)
        if node.brace:
            yield _format_cell(body)
        elif len(row) == 1:
            yield f'<mtd style="padding:0.2em 0">{body}</mtd>'
        else:
            side, gap = ("left", "0") if place % 2 else ("right", "2em" if place else "0")
            yield f'<mtd style="text-align:{side};padding:0.2em 0 0.2em {gap}">{body}</mtd>'
