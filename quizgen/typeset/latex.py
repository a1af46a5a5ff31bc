"""LaTeX for LaTeX with amsmath, MathJax (Anki, Moodle) and KaTeX.

Two closing braces never touch, because Anki would read them as the end of a cloze. ``<`` and ``&``
are left as they are: whoever puts the result into HTML escapes it.
"""

from __future__ import annotations

import re
from functools import lru_cache, singledispatch

from quizgen.errors import RenderError
from quizgen.locale import numbers_in
from quizgen.typeset import nodes as n
from quizgen.typeset.names import GREEK, KNOWN
from quizgen.typeset.separators import separated, separator
from quizgen.typeset.tables import known
from quizgen.typeset.units import TIGHT, parts
from quizgen.typeset.words import words_of

_known = known("LaTeX")

_LETTERS = {char: "\\" + word for word, char in GREEK.items() if word != "lamda"}
_LETTERS |= {"ε": r"\varepsilon", "φ": r"\varphi", "ℓ": r"\ell"}
_OPERATORS = {
    "": "",
    " ": r"\,",
    "neg": "-",
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
    **{same: same for same in "+-=<>/:"},
}
_BRACKETS = {
    "(": "(",
    ")": ")",
    "[": "[",
    "]": "]",
    "{": r"\{",
    "}": r"\}",
    "|": "|",
    "⌊": r"\lfloor",
    "⌋": r"\rfloor",
    "⌈": r"\lceil",
    "⌉": r"\rceil",
}
_ACCENTS = {"bar": r"\bar", "hat": r"\hat", "tilde": r"\tilde"}
_SIGNS = {"∑": r"\sum", "∏": r"\prod", "∫": r"\int"}
_TALL = re.compile(r"\\(?:[dt]?frac|begin|sum|prod|int)\b")
_TOUCHING = re.compile(r"\}(?=\})")
_SPECIAL = re.compile(r"([%#&_$])")


def latex(node: n.Node, lang: str = "en") -> str:
    r"""Write a layout as LaTeX mathematics, without delimiters.

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
    >>> from quizgen.typeset import latex, name
    >>> latex(name("p'_x"))
    "p'_{x}"
    """
    return _TOUCHING.sub("} ", _emit(node, lang))


@singledispatch
def _emit(node: n.Node, lang: str) -> str:
    raise RenderError(f"no LaTeX for {type(node).__name__} ({lang})")


@_emit.register
def _number(node: n.Number, lang: str) -> str:
    text = numbers_in(lang, node.text).replace(",", "{,}")  # no blank behind a decimal comma
    return re.sub(r"\s", r"\\,", text)


@_emit.register
def _ident(node: n.Ident, _lang: str) -> str:
    letter = _LETTERS.get(node.text, node.text)
    if node.bold:
        return rf"\mathbf{{{letter}}}" if letter.isalpha() else rf"\boldsymbol{{{letter}}}"
    return letter


@_emit.register
def _word(node: n.Word, _lang: str) -> str:
    return rf"\mathrm{{{_escaped(node.text)}}}"


def _escaped(text: str) -> str:
    return _SPECIAL.sub(r"\\\1", text)


@_emit.register
def _text(node: n.Text, lang: str) -> str:
    return rf"\text{{ {_known(words_of(lang).printed, node.key, 'word')} }}"


@lru_cache(maxsize=512)
def _unit_text(text: str) -> str:
    written = ""
    for part in parts(text):
        sign = r" \cdot " if part.sign == "·" else part.sign
        written += sign + _simple_unit(part.shown) + (f"^{{{part.power}}}" if part.power else "")
    return written


def _simple_unit(shown: str) -> str:
    if shown == "°":
        return r"^{\circ}"
    if shown == "e⁻":
        return r"\mathrm{e}^{-}"
    return rf"\text{{{shown}}}" if "µ" in shown else rf"\mathrm{{{_escaped(shown)}}}"


@_emit.register
def _unit(node: n.Unit, _lang: str) -> str:
    return _unit_text(node.text)


@_emit.register
def _quantity(node: n.Quantity, lang: str) -> str:
    space = "" if node.unit.text in TIGHT else r"\,"
    return f"{_emit(node.value, lang)}{space}{_unit_text(node.unit.text)}"


@_emit.register
def _op(node: n.Op, _lang: str) -> str:
    return _known(_OPERATORS, node.name, "operator")


@_emit.register
def _row(node: n.Row, lang: str) -> str:
    return " ".join([text for item in separated(node.items, lang) if (text := _emit(item, lang))])


@_emit.register
def _frac(node: n.Frac, lang: str) -> str:
    top, bottom = _emit(node.top, lang), _emit(node.bottom, lang)
    return f"{top} / {bottom}" if node.inline else rf"\frac{{{top}}}{{{bottom}}}"


@_emit.register
def _root(node: n.Root, lang: str) -> str:
    index = f"[{_emit(node.index, lang)}]" if node.index else ""
    return rf"\sqrt{index}{{{_emit(node.body, lang)}}}"


@_emit.register
def _scripts(node: n.Scripts, lang: str) -> str:
    low = "" if node.sub is None else f"_{{{_emit(node.sub, lang)}}}"
    high = "" if node.sup is None else f"^{{{_emit(node.sup, lang)}}}"
    base = _emit(node.base, lang)
    if node.primes:  # a prime is a superscript: the exponent must follow it at once
        return base + "'" * node.primes + high + low
    return base + low + high


@_emit.register
def _accent(node: n.Accent, lang: str) -> str:
    return f"{_known(_ACCENTS, node.kind, 'accent')}{{{_emit(node.base, lang)}}}"


@_emit.register
def _fence(node: n.Fence, lang: str) -> str:
    body = _emit(node.body, lang)
    left, right = (_known(_BRACKETS, bracket, "bracket") for bracket in node.kind)
    if _TALL.search(body):
        return rf"\left{left} {body} \right{right}"
    return f"{left}{' ' * left[1:].isalpha()}{body}{' ' * right[1:].isalpha()}{right}"


@_emit.register
def _func(node: n.Func, lang: str) -> str:
    between = f"{separator(node.args, lang).name} "
    arguments = between.join([_emit(arg, lang) for arg in node.args])
    head = _head(node.head, lang)
    if _TALL.search(arguments):
        return rf"{head}\!\left( {arguments} \right)"
    return f"{head}({arguments})"


def _head(node: n.Node, lang: str) -> str:
    if isinstance(node, n.Word):
        return f"\\{node.text}" if node.text in KNOWN else rf"\operatorname{{{node.text}}}"
    if isinstance(node, n.Scripts):
        return _head(node.base, lang) + _scripts(node.alone, lang)
    return _emit(node, lang)


@_emit.register
def _big(node: n.Big, lang: str) -> str:
    return _known(_SIGNS, node.sign, "sign") + _scripts(node.bounds, lang)


@_emit.register
def _under(node: n.Under, lang: str) -> str:
    if isinstance(node.base, n.Word) and node.base.text in KNOWN:
        return f"{_head(node.base, lang)}_{{{_emit(node.below, lang)}}}"
    return rf"\underset{{{_emit(node.below, lang)}}}{{{_emit(node.base, lang)}}}"


@_emit.register
def _cases(node: n.Cases, lang: str) -> str:
    rows = []
    for value, condition in node.rows:
        when = r"\text{otherwise}".replace("otherwise", words_of(lang).printed["otherwise"])
        if condition is not None:
            when = _case(_emit(condition, lang), lang)
        rows.append(f"{_emit(value, lang)} & {when}")
    return r"\begin{cases} " + r" \\ ".join(rows) + r" \end{cases}"


def _case(condition: str, lang: str) -> str:
    before, after = words_of(lang).printed["if"].split("{}")
    left = rf"\text{{{before}}} " if before else ""
    return left + condition + (rf" \text{{{after}}}" if after else "")


@_emit.register
def _matrix(node: n.Matrix, lang: str) -> str:
    rows = [" & ".join([_emit(cell, lang) for cell in row]) for row in node.rows]
    return r"\begin{pmatrix} " + r" \\ ".join(rows) + r" \end{pmatrix}"
