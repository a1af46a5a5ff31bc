"""Formulas in words, for alternative texts: nothing in the layout is left unsaid or ambiguous.

Fractions, roots and powers of a single letter or number are read the short way; longer ones say
where they end, so that a listener can write the formula down.
"""

from __future__ import annotations

import re
from functools import lru_cache, singledispatch

from quizgen.errors import RenderError
from quizgen.locale import numbers_in
from quizgen.typeset import nodes as n
from quizgen.typeset.names import GREEK
from quizgen.typeset.tables import known
from quizgen.typeset.units import Part, parts
from quizgen.typeset.words import Words, words_of

_known = known("reading")

_BINDING = tuple(map(n.Op, ("", "·", "×", "mod")))
_BOUNDS = tuple(map(n.Op, "<≤"))
_COMMAS = re.compile(r"[ ,]+([,;])")
_SPACES = re.compile(r"  +")
_GREEK_NAMES = {char: word for word, char in GREEK.items() if word != "lamda"}


def spoken(node: n.Node, lang: str = "en") -> str:
    """Read a layout aloud.

    Parameters
    ----------
    node : Node
        The layout.
    lang : str
        A language of ``quizgen.locale``.

    Raises
    ------
    RenderError
        If the layout holds something that has no reading.

    Examples
    --------
    >>> from quizgen.typeset import name, spoken
    >>> spoken(name("p'_x"))
    'p prime sub x'
    """
    return _SPACES.sub(" ", _COMMAS.sub(r"\1", _say(node, lang))).strip(" ,")


def simple(node: n.Node | None) -> bool:
    """Whether a listener hears a node as one thing."""
    match node:
        case n.Number() | n.Ident() | n.Word() | n.Quantity() | n.Unit() | None:
            return True
        case n.Scripts(base=base, sub=sub, sup=None):
            return simple(base) and simple(sub)
        case n.Accent(base=base):
            return simple(base)
        case n.Row(items=(n.Op(name="neg"), n.Number() | n.Quantity() | n.Ident())):
            return True
        case n.Row(items=items, level=n.ATOM):
            return all(map(simple, items))
    return False


def _phrase(lang: str, key: str, nodes: tuple[n.Node, ...]) -> str:
    words = words_of(lang)
    table = words.short if all(map(simple, nodes)) else words.long
    return str(table[key]).format(*[_say(node, lang) for node in nodes])


@singledispatch
def _say(node: n.Node, lang: str) -> str:
    raise RenderError(f"no reading for {type(node).__name__} ({lang})")


@_say.register
def _number(node: n.Number, lang: str) -> str:
    return "".join(numbers_in(lang, node.text).split())


def letter(char: str, lang: str) -> str:
    """Say one letter; a capital is announced, since x and X differ."""
    words = words_of(lang)
    lower = char.lower()
    said = words.letters.get(lower) or words.greek.get(lower) or _GREEK_NAMES.get(lower)
    if said is None:
        said = char if char.isascii() else _known(words.greek, char, "letter")
    if char == lower:
        return str(said)
    as_written = char.isascii() and not words.letters
    return words.capital.format(char if as_written else said)


@_say.register
def _ident(node: n.Ident, lang: str) -> str:
    said = letter(node.text, lang)
    return words_of(lang).short["bold"].format(said) if node.bold else said


@_say.register
def _word(node: n.Word, lang: str) -> str:
    words = words_of(lang)
    if node.text.isupper() and words.letters:
        return "".join([words.letters.get(char.lower(), char) for char in node.text])
    return words.names.get(node.text, node.text)


@_say.register
def _text(node: n.Text, lang: str) -> str:
    return _known(words_of(lang).printed, node.key, "word")


@lru_cache(maxsize=512)
def unit_words(text: str, lang: str, *, one: bool = False) -> str:
    """Say a unit, in the singular after the number one."""
    words = words_of(lang)
    said = ""
    for part in parts(text):
        below = part.sign == "/" or part.power.startswith("-")
        word = _simple_unit(part, words, one=one or below)
        word = _joined(words.unit_joints.get(part.power.lstrip("-"), "{}"), word)
        joint = words.unit_joints["/" if below else "·"]
        said = joint.format(said, word) if said or below else word
    return said.strip()


def _simple_unit(part: Part, words: Words, *, one: bool) -> str:
    if part.name in words.units:
        return words.units[part.name][not one]
    prefix = {"µ": "u", "μ": "u"}.get(part.name[0], part.name[0])
    if part.name[1:] not in words.units:
        return part.shown  # a unit of the bank's own
    return _joined(_known(words.prefixes, prefix, "prefix"), words.units[part.name[1:]][not one])


def _joined(pattern: str, word: str) -> str:
    """A word in its place; one that goes on with another word begins with a small letter."""
    return pattern.format(word if pattern.startswith("{}") else word[:1].lower() + word[1:])


@_say.register
def _unit(node: n.Unit, lang: str) -> str:
    return unit_words(node.text, lang)


@_say.register
def _quantity(node: n.Quantity, lang: str) -> str:
    one = node.value == n.Number("1")
    return f"{_say(node.value, lang)} {unit_words(node.unit.text, lang, one=one)}"


@_say.register
def _op(node: n.Op, lang: str) -> str:
    return "" if node.name == " " else _known(words_of(lang).operators, node.name, "operator")


@_say.register
def _row(node: n.Row, lang: str) -> str:
    items = node.items
    if node.level == n.ATOM:
        items = tuple([item for item in items if item != n.Op(",")])
    if _two_bounds(items):
        both = (*items[:3], n.Text("and"), *items[2:])
        return " ".join([_say(item, lang) for item in both])
    following = (*items[1:], None)
    return " ".join([_ended(*pair, lang) for pair in zip(items, following, strict=True)])


def _two_bounds(items: tuple[n.Node, ...]) -> bool:
    """0 ≤ x < 1 is read as two statements about x."""
    return len(items) == 5 and all(item in _BOUNDS for item in items[1::2])


def _ended(node: n.Node, following: n.Node | None, lang: str) -> str:
    """Say where a fraction ends if a factor comes after it."""
    if isinstance(node, n.Frac) and not node.inline and following in _BINDING:
        return _frac(node, lang, "long")
    return _say(node, lang)


@_say.register
def _frac(node: n.Frac, lang: str, length: str = "short") -> str:
    words = words_of(lang)
    said = _say(node.top, lang), _say(node.bottom, lang)
    if node.inline or (length == "short" and simple(node.top) and simple(node.bottom)):
        return words.short["frac"].format(*said)
    deep = _has_frac(node.top) or _has_frac(node.bottom)
    return words.long["deep" if deep else "frac"].format(*said)


def _has_frac(node: n.Node) -> bool:
    match node:
        case n.Frac():
            return True
        case n.Row(items=items) | n.Func(args=items):
            return any(map(_has_frac, items))
        case n.Fence(body=body) | n.Root(body=body):
            return _has_frac(body)
    return False


@_say.register
def _root(node: n.Root, lang: str) -> str:
    if node.index is None:
        return _phrase(lang, "sqrt", (node.body,))
    return _phrase(lang, "root", (node.index, node.body))


@_say.register
def _scripts(node: n.Scripts, lang: str) -> str:
    short = words_of(lang).short
    said = _say(node.base, lang)
    for _ in range(node.primes):
        said = short["prime"].format(said)
    if node.sub is not None:
        said = short["sub"].format(said, _say(node.sub, lang))
    return said if node.sup is None else _raised(node, said, lang)


def _raised(node: n.Scripts, base: str, lang: str) -> str:
    words = words_of(lang)
    if isinstance(node.sup, n.Number) and node.sup.text in words.powers:
        grouped = isinstance(node.base, n.Fence) and node.base.kind == "()"
        return words.powers[node.sup.text + "…" * grouped].format(base)
    if node.sup == n.Op("ᵀ"):
        return f"{base} {_say(node.sup, lang)}"
    table = words.short if simple(node.sup) else words.long
    return table["power"].format(base, _say(node.sup, lang) if node.sup else "")


@_say.register
def _accent(node: n.Accent, lang: str) -> str:
    return _known(words_of(lang).accents, node.kind, "accent").format(_say(node.base, lang))


@_say.register
def _fence(node: n.Fence, lang: str) -> str:
    words = words_of(lang)
    if node.kind in words.intervals and isinstance(node.body, n.Row):
        bounds = [_say(item, lang) for item in node.body.items if item != n.Op(",")]
        if len(bounds) == 2 and len(node.body.items) == 3:
            return words.intervals[node.kind].format(*bounds)
    long = node.kind + "…"
    key = long if long in words.brackets and not simple(node.body) else node.kind
    return _known(words.brackets, key, "brackets").format(_say(node.body, lang))


@_say.register
def _func(node: n.Func, lang: str) -> str:
    words = words_of(lang)
    said = [_say(arg, lang) for arg in node.args]
    if not all(map(simple, node.args)) or not _plain(node.head):
        return words.long["func"].format(_head(node.head, lang), ", ".join(said))
    listed = ", ".join(said)
    if len(said) > 1:
        listed = words.short["last"].format(", ".join(said[:-1]), said[-1])
    if isinstance(node.head, n.Ident):
        return words.short["of"].format(_say(node.head, lang), listed)
    if isinstance(node.head, n.Scripts) and node.head.sup is not None:
        return words.short["apply"].format(_head(node.head, lang), listed)
    if isinstance(node.head, n.Scripts) and node.head.sub is not None:
        return words.short["base"].format(_say(node.head.sub, lang), listed)
    name = node.head.text if isinstance(node.head, n.Word) else ""
    return _known(words.functions, name, "function")[0].format(listed)


def _plain(head: n.Node) -> bool:
    """Whether a head is a bare function name, or a logarithm with its base."""
    if isinstance(head, n.Scripts):
        return (head.base == n.Word("log")) is (head.sub is not None)
    return isinstance(head, n.Word | n.Ident)


def _head(node: n.Node, lang: str) -> str:
    words = words_of(lang)
    if isinstance(node, n.Word):
        return _known(words.functions, node.text, "function")[1]
    if isinstance(node, n.Scripts) and node.sup is not None:
        bare = n.Scripts(node.base, node.sub) if node.sub else node.base
        return _raised(node, _head(bare, lang), lang)
    if isinstance(node, n.Scripts) and node.sub is not None:
        if node.base == n.Word("log"):
            return words.short["base alone"].format(_say(node.sub, lang))
        return words.short["sub"].format(_head(node.base, lang), _say(node.sub, lang))
    return _say(node, lang)


@_say.register
def _big(node: n.Big, lang: str) -> str:
    what, low, high, closing = _known(words_of(lang).signs, node.sign, "sign")
    said = [what]
    said += [low.format(_say(node.lower, lang))] if node.lower else []
    said += [high.format(_say(node.upper, lang))] if node.upper else []
    return " ".join([*said, closing])


@_say.register
def _under(node: n.Under, lang: str) -> str:
    return words_of(lang).short["below"].format(_head(node.base, lang), _say(node.below, lang))


@_say.register
def _cases(node: n.Cases, lang: str) -> str:
    short = words_of(lang).short
    rows = []
    for value, condition in node.rows:
        if condition is None:
            rows.append(short["otherwise"].format(_say(value, lang)))
        else:
            rows.append(short["case"].format(_say(value, lang), _say(condition, lang)))
    return "; ".join(rows)


@_say.register
def _matrix(node: n.Matrix, lang: str) -> str:
    words = words_of(lang)
    rows = [", ".join([_say(cell, lang) for cell in row]) for row in node.rows]
    said = [words.short["row"].format(f"{i}: {row}") for i, row in enumerate(rows, 1)]
    return words.long["matrix"].format("; ".join(said))
