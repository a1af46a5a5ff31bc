"""Typst mathematics, without the dollar signs.

Letters are separated by spaces (two together would be an unknown variable), commas and slashes
that are meant as such are escaped, and primes stand before subscripts.
"""

from __future__ import annotations

from functools import lru_cache, singledispatch

from quizgen.errors import RenderError
from quizgen.locale import numbers_in
from quizgen.typeset import nodes as n
from quizgen.typeset.names import KNOWN
from quizgen.typeset.separators import separated, separator
from quizgen.typeset.tables import known
from quizgen.typeset.units import TIGHT, parts
from quizgen.typeset.words import words_of

_known = known("Typst")

_OPERATORS = {
    "": "",
    " ": "thin",
    "neg": "-",
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
}
_BRACKETS = {
    "(": "paren.l",
    ")": "paren.r",
    "[": "bracket.l",
    "]": "bracket.r",
    "{": "brace.l",
    "}": "brace.r",
}
_CALLS = {"||": "abs", "⌊⌋": "floor", "⌈⌉": "ceil"}
_ACCENTS = {"bar": "macron", "hat": "hat", "tilde": "tilde"}
_UNITS = {"e⁻": '"e"^(-)'}
_SIGNS = {"∑": "sum", "∏": "product", "∫": "integral"}


def typst(node: n.Node, lang: str = "en") -> str:
    """Write a layout as Typst mathematics.

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
    return _emit(node, lang)


def quoted(text: str) -> str:
    r"""Make a Typst string literal.

    Examples
    --------
    >>> quoted('a "b"')
    '"a \\"b\\""'
    """
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


@singledispatch
def _emit(node: n.Node, lang: str) -> str:
    raise RenderError(f"no Typst for {type(node).__name__} ({lang})")


@_emit.register
def _number(node: n.Number, lang: str) -> str:
    text = numbers_in(lang, node.text).replace(" ", "\u202f")
    return text if text.replace(".", "", 1).isdigit() and text.isascii() else quoted(text)


@_emit.register
def _ident(node: n.Ident, _lang: str) -> str:
    return f"upright(bold({node.text}))" if node.bold else node.text


@_emit.register
def _word(node: n.Word, _lang: str) -> str:
    return quoted(node.text)


@_emit.register
def _text(node: n.Text, lang: str) -> str:
    return quoted(f" {_known(words_of(lang).printed, node.key, 'word')} ")


@lru_cache(maxsize=512)
def _unit_text(text: str) -> str:
    written = ""
    for part in parts(text):
        sign = {"·": "dot.op", "/": "slash", "": ""}[part.sign]
        power = f"^({part.power})" if part.power else ""
        written += f"{sign}{_UNITS.get(part.shown) or quoted(part.shown)}{power}"
    return written


@_emit.register
def _unit(node: n.Unit, _lang: str) -> str:
    return _unit_text(node.text)


@_emit.register
def _quantity(node: n.Quantity, lang: str) -> str:
    space = "" if node.unit.text in TIGHT else " thin"
    return f"{_emit(node.value, lang)}{space}{_unit_text(node.unit.text)}"


@_emit.register
def _op(node: n.Op, _lang: str) -> str:
    return _known(_OPERATORS, node.name, "operator")


@_emit.register
def _row(node: n.Row, lang: str) -> str:
    return _spaced([_emit(item, lang) for item in separated(node.items, lang)])


def _spaced(texts: list[str]) -> str:
    """Join by spaces, except beside a string literal, where Typst would print the space."""
    written = ""
    for text in texts:
        tight = not written or not text or written[-1] == '"' or text[0] == '"'
        written += text if tight else " " + text
    return written


@_emit.register
def _frac(node: n.Frac, lang: str) -> str:
    top, bottom = _emit(node.top, lang), _emit(node.bottom, lang)
    if node.inline:
        return _spaced([top, "slash", bottom])
    return f"frac({top}, {bottom})"


@_emit.register
def _root(node: n.Root, lang: str) -> str:
    body = _emit(node.body, lang)
    return f"root({_emit(node.index, lang)}, {body})" if node.index else f"sqrt({body})"


@_emit.register
def _scripts(node: n.Scripts, lang: str) -> str:
    written = _emit(node.base, lang) + "'" * node.primes
    if node.sub is not None:
        written += f"_({_emit(node.sub, lang)})"
    if node.sup is not None:
        written += f"^({_emit(node.sup, lang)})"
    return written


@_emit.register
def _accent(node: n.Accent, lang: str) -> str:
    return f"{_known(_ACCENTS, node.kind, 'accent')}({_emit(node.base, lang)})"


@_emit.register
def _fence(node: n.Fence, lang: str) -> str:
    body = _emit(node.body, lang)
    if node.kind == "()":
        return f"({body})"
    if node.kind in _CALLS:
        return f"{_CALLS[node.kind]}({body})"
    left, right = (_known(_BRACKETS, bracket, "bracket") for bracket in node.kind)
    return f"lr({left} {body} {right})"


@_emit.register
def _func(node: n.Func, lang: str) -> str:
    between = f" {_OPERATORS[separator(node.args, lang).name]} "
    arguments = between.join([_emit(arg, lang) for arg in node.args])
    return f"{_head(node.head, lang)} ({arguments})"


def _head(node: n.Node, lang: str) -> str:
    if isinstance(node, n.Word):
        return node.text if node.text in KNOWN else f"op({quoted(node.text)})"
    if isinstance(node, n.Scripts):
        return _head(node.base, lang) + _scripts(node.alone, lang)
    return _emit(node, lang)


@_emit.register
def _big(node: n.Big, lang: str) -> str:
    return _known(_SIGNS, node.sign, "sign") + _scripts(node.bounds, lang)


@_emit.register
def _under(node: n.Under, lang: str) -> str:
    base = _head(node.base, lang)
    if isinstance(node.base, n.Word) and node.base.text in {"lim", "max", "min"}:
        return f"limits({base})_({_emit(node.below, lang)})"
    return f"attach({base}, b: {_emit(node.below, lang)})"


@_emit.register
def _cases(node: n.Cases, lang: str) -> str:
    rows = []
    for value, condition in node.rows:
        when = quoted(words_of(lang).printed["otherwise"])
        if condition is not None:
            when = _case(_emit(condition, lang), lang)
        rows.append(f"{_emit(value, lang)} quad & {when}")
    return "cases(" + ", ".join(rows) + ")"


def _case(condition: str, lang: str) -> str:
    before, after = (half.strip() for half in words_of(lang).printed["if"].split("{}"))
    left = quoted(f"{before} ") if before else ""
    return left + condition + (quoted(f" {after}") if after else "")


@_emit.register
def _matrix(node: n.Matrix, lang: str) -> str:
    rows = [", ".join([_emit(cell, lang) for cell in row]) for row in node.rows]
    return "mat(" + "; ".join(rows) + ")"
