"""Formulas in words, for alternative texts: nothing in the layout is left unsaid or ambiguous.

Fractions, roots and powers of a single letter or number are read the short way; longer ones say
where they end, so that a listener can write the formula down.
"""

from __future__ import annotations

import re
from functools import lru_cache, singledispatch

from msgspec.structs import replace

from quizgen.core.errors import RenderError
from quizgen.locale import localise_numbers
from quizgen.typeset import nodes as n
from quizgen.typeset.builders import RELATIONS
from quizgen.typeset.names import GREEK
from quizgen.typeset.printer import (
    SpeechWords,
    UnitPart,
    load_speech_words,
    split_unit,
    strict_lookup,
)
from quizgen.typeset.signs import ARROWS, find_styled_letter
from quizgen.typeset.signs import RELATIONS as SIGNED_RELATIONS

_known = strict_lookup("reading")

_BINDING = tuple(map(n.OperatorSign, ("", "·", "×", "mod")))
_GREEK = frozenset(GREEK.values())
_MINUS_ONE = n.MathRow((n.OperatorSign("neg"), n.Digits("1")), n.NEGATIVE)
_BOUNDS = tuple(map(n.OperatorSign, "<≤"))
_RELATING = tuple(map(n.OperatorSign, (*RELATIONS, *ARROWS, *SIGNED_RELATIONS, ",", ";", "|")))
_COMMAS = re.compile(r"[ ,]+([,;:])")
_SPACES = re.compile(r"  +")
_GREEK_NAMES = {char: word for word, char in GREEK.items() if word != "lamda"}


def to_speech(node: n.Node, lang: str = "en") -> str:
    """Return a layout as it is read aloud.

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
    >>> from quizgen.typeset import lay_out_name, to_speech
    >>> to_speech(lay_out_name("p'_x"))
    'p prime sub x'
    """
    return _SPACES.sub(" ", _COMMAS.sub(r"\1", _say_node(node, lang))).strip(" ,")


def is_simple(node: n.Node | None) -> bool:
    """Return whether a listener hears a node as one thing."""
    match node:
        case (
            n.Digits()
            | n.Ident()
            | n.Word()
            | n.Phrase()
            | n.NumberWithUnit()
            | n.UnitText()
            | None
        ):
            return True
        case n.Scripts(base=base, sub=sub, sup=None):
            return is_simple(base) and is_simple(sub)
        case n.Accent(base=base):
            return is_simple(base)
        case n.MathRow(
            items=(n.OperatorSign(name="neg"), n.Digits() | n.NumberWithUnit() | n.Ident())
        ):
            return True
        case n.MathRow(items=items, level=n.ATOM):
            return all(map(is_simple, items))
    return False


def _say_phrase(lang: str, key: str, nodes: tuple[n.Node, ...]) -> str:
    """Return a phrase with its parts, in its short form if all of them are simple."""
    words = load_speech_words(lang)
    table = words.short if all(map(is_simple, nodes)) else words.long
    return str(table[key]).format(*[_say_node(node, lang) for node in nodes])


@singledispatch
def _say_node(node: n.Node, lang: str) -> str:
    """Return a node as it is read aloud; each kind of node registers its own function.

    Raises
    ------
    RenderError
        For a kind that has none.
    """
    raise RenderError(f"no reading for {type(node).__name__} ({lang})")


@_say_node.register
def _say_digits(node: n.Digits, lang: str) -> str:
    """Return digits without spaces, which a voice would read as several numbers."""
    return "".join(localise_numbers(lang, node.text).split())


def say_letter(char: str, lang: str) -> str:
    """Return one letter as it is spoken; a capital is announced, since x and X differ.

    Raises
    ------
    RenderError
        If a language has no name for it.
    """
    words = load_speech_words(lang)
    lower = char.lower()
    said = words.letters.get(lower) or words.greek.get(lower) or _GREEK_NAMES.get(lower)
    if said is None:
        said = char if char.isascii() else _known(words.greek, char, "letter")
    if char == lower:
        return str(said)
    as_written = char.isascii() and not words.letters
    return words.capital.format(char if as_written else said)


@_say_node.register
def _say_ident(node: n.Ident, lang: str) -> str:
    """Return a letter, announced if it is bold."""
    words = load_speech_words(lang)
    if node.style:
        whole = words.greek.get(find_styled_letter(node.text, node.style))
        return whole or words.short[node.style].format(say_letter(node.text, lang))
    said = say_letter(node.text, lang)
    return load_speech_words(lang).short["bold"].format(said) if node.bold else said


@_say_node.register
def _say_phrase_of_author(node: n.Phrase, _lang: str) -> str:
    """Return a phrase as the author wrote it."""
    return node.text.strip()


@_say_node.register
def _say_gap(node: n.Gap, _lang: str) -> str:
    """Return a pause for a wide gap; narrow ones are silent."""
    return "," if node.width in {"quad", "qquad"} else ""


@_say_node.register
def _say_function_name(node: n.FunctionName, lang: str) -> str:
    """Return how the name of a function is read out."""
    return _say_function_head(n.Word(node.text), lang)


@_say_node.register
def _say_word(node: n.Word, lang: str) -> str:
    """Return a word's name in a language; abbreviations letter by letter if it names letters."""
    words = load_speech_words(lang)
    if words.letters and (node.text.isupper() or len(node.text) == 1):
        return "".join([words.letters.get(char.lower(), char) for char in node.text])
    if not node.text.isascii() and node.text not in words.names:
        return " ".join([say_letter(c.lower(), lang) if c in _GREEK else c for c in node.text])
    return words.names.get(node.text, node.text)


@_say_node.register
def _say_reader_word(node: n.ReaderWord, lang: str) -> str:
    """Return a word between formulas, such as *and*."""
    return _known(load_speech_words(lang).printed, node.key, "word")


@lru_cache(maxsize=512)
def say_unit(text: str, lang: str, *, one: bool = False) -> str:
    """Return a unit as it is spoken, in the singular after the number one."""
    words = load_speech_words(lang)
    said, within = "", False
    for part in split_unit(text):
        below = part.sign == "/" or part.power.startswith("-")
        within = bool(part.opening) or within
        word = _simple_unit(part, words, one=one or below or within)
        within = within and not part.closing
        word = _insert_word(words.unit_joints.get(part.power.lstrip("-"), "{}"), word)
        joint = words.unit_joints["/" if below else "·"]
        said = joint.format(said, word) if said or below else word
    return said.strip()


def _simple_unit(part: UnitPart, words: SpeechWords, *, one: bool) -> str:
    """Return one unit with its prefix; one that a bank defines is returned as it is printed."""
    if part.name in words.units:
        return words.units[part.name][not one]
    prefix = {"µ": "u", "μ": "u"}.get(part.name[0], part.name[0])
    if part.name[1:] not in words.units:
        return part.shown  # a unit of the bank's own
    return _insert_word(
        _known(words.prefixes, prefix, "prefix"), words.units[part.name[1:]][not one]
    )


def _insert_word(pattern: str, word: str) -> str:
    """Return a pattern with a word; one that goes on with another begins with a small letter."""
    return pattern.format(word if pattern.startswith("{}") else word[:1].lower() + word[1:])


@_say_node.register
def _say_unit_text(node: n.UnitText, lang: str) -> str:
    """Return a unit that stands alone."""
    return say_unit(node.text, lang)


@_say_node.register
def _say_quantity(node: n.NumberWithUnit, lang: str) -> str:
    """Return a number with its unit, in the singular after one."""
    one = node.value == n.Digits("1")
    return f"{_say_node(node.value, lang)} {say_unit(node.unit.text, lang, one=one)}"


@_say_node.register
def _say_operator(node: n.OperatorSign, lang: str) -> str:
    """Return an operator's word; nothing for an implied product."""
    return (
        "" if node.name == " " else _known(load_speech_words(lang).operators, node.name, "operator")
    )


@_say_node.register
def _say_row(node: n.MathRow, lang: str) -> str:
    """Return the items of a row in order; two bounds as two statements."""
    if not node.items:
        return ""
    items = tuple([item for item in node.items if not _is_silent_gap(item)])
    if node.level == n.ATOM:
        items = tuple([item for item in items if item != n.OperatorSign(",")])
    if bounds := _find_two_bounds(items):
        between = items[bounds[0] + 1 : bounds[1]]
        both = (*items[: bounds[1]], n.ReaderWord("and"), *between, *items[bounds[1] :])
        return " ".join([_say_node(item, lang) for item in both])
    following = (*items[1:], None)
    return " ".join(
        [_say_with_fraction_end(*pair, lang) for pair in zip(items, following, strict=True)]
    )


def _is_silent_gap(item: n.Node) -> bool:
    """Return whether a node is a gap too narrow for a pause."""
    return isinstance(item, n.Gap) and item.width not in {"quad", "qquad"}


def _find_two_bounds(items: tuple[n.Node, ...]) -> tuple[int, ...]:
    """Return the signs of 0 ≤ x < 1, which is read as two statements about x."""
    relations = [place for place, item in enumerate(items) if item in _RELATING]
    both = len(relations) == 2 and all(items[place] in _BOUNDS for place in relations)
    return tuple(relations) if both else ()


def _say_with_fraction_end(node: n.Node, following: n.Node | None, lang: str) -> str:
    """Say where a fraction ends if a factor comes after it."""
    bare = node.body if isinstance(node, n.Display) else node
    if isinstance(bare, n.Frac) and not bare.inline and _binds(following):
        return _say_fraction(bare, lang, "long")
    return _say_node(node, lang)


def _binds(following: n.Node | None) -> bool:
    """Whether what follows is a factor, with or without a sign in front."""
    if following is None or isinstance(following, n.Gap | n.Phrase):
        return False
    return following in _BINDING if isinstance(following, n.OperatorSign) else True


@_say_node.register
def _say_fraction(node: n.Frac, lang: str, length: str = "short") -> str:
    """Return a fraction; a long one with its beginning and end, a deep one as such."""
    words = load_speech_words(lang)
    said = _say_node(node.top, lang), _say_node(node.bottom, lang)
    if node.inline or (length == "short" and is_simple(node.top) and is_simple(node.bottom)):
        return words.short["frac"].format(*said)
    deep = _has_frac(node.top) or _has_frac(node.bottom)
    return words.long["deep" if deep else "frac"].format(*said)


def _has_frac(node: n.Node) -> bool:
    """Return whether a fraction stands inside a node."""
    match node:
        case n.Frac():
            return True
        case n.MathRow(items=items) | n.Func(args=items):
            return any(map(_has_frac, items))
        case n.Fenced(body=body) | n.Root(body=body):
            return _has_frac(body)
    return False


@_say_node.register
def _say_root(node: n.Root, lang: str) -> str:
    """Return a root, with its index unless it is a square root."""
    if node.index is None:
        return _say_phrase(lang, "sqrt", (node.body,))
    return _say_phrase(lang, "root", (node.index, node.body))


@_say_node.register
def _say_scripts(node: n.Scripts, lang: str) -> str:
    """Return a base with its primes, subscript and power."""
    short = load_speech_words(lang).short
    if node.base == n.Phrase(""):
        return _say_indices_before(node, lang)
    if isinstance(node.base, n.Fenced) and "." in node.base.kind:
        ends = [_say_node(end, lang) for end in (node.sub, node.sup) if end is not None]
        key = "evaluated" if len(ends) == 1 else "evaluated to"
        return short[key].format(_say_node(node.base.body, lang), *ends)
    if isinstance(node.base, n.FunctionName):
        return _say_function_head(replace(node, base=n.Word(node.base.text)), lang)
    said = _say_node(node.base, lang)
    for _ in range(node.primes):
        said = short["prime"].format(said)
    if node.sub is not None:
        table = load_speech_words(lang).long if _is_long_index(node.sub) else short
        said = table["sub"].format(said, _say_node(node.sub, lang))
    return said if node.sup is None else _say_power(node, said, lang)


def _is_long_index(sub: n.Node) -> bool:
    """Whether a listener must hear where a subscript ends."""
    return isinstance(sub, n.MathRow) and sub.level in {n.SUM, n.RELATION}


def _say_indices_before(node: n.Scripts, lang: str) -> str:
    """Return indices of what comes after them, as of an isotope."""
    short = load_speech_words(lang).short
    both = (("upper index", node.sup), ("lower index", node.sub))
    return ", ".join([short[key].format(_say_node(one, lang)) for key, one in both if one]) + ","


def _say_power(node: n.Scripts, base: str, lang: str) -> str:
    """Return a power; squares and cubes have words of their own, a transpose its sign's.

    ``base`` is the base as it is spoken.
    """
    words = load_speech_words(lang)
    if isinstance(node.sup, n.Digits) and node.sup.text in words.powers:
        grouped = isinstance(node.base, n.Fenced) and node.base.kind == "()"
        return words.powers[node.sup.text + "…" * grouped].format(base)
    if isinstance(node.sup, n.OperatorSign):
        said = words.raised.get(node.sup.name) or _say_node(node.sup, lang)
        return f"{base} {said}"
    if node.sup == _MINUS_ONE and isinstance(node.base, n.FunctionName | n.Func | n.Matrix):
        return words.powers["inverse"].format(base)
    table = words.short if is_simple(node.sup) else words.long
    return table["power"].format(base, _say_node(node.sup, lang) if node.sup else "")


@_say_node.register
def _say_accent(node: n.Accent, lang: str) -> str:
    """Return a letter with the word for its accent."""
    accents, long = load_speech_words(lang).accents, node.kind + "…"
    key = long if long in accents and not is_simple(node.base) else node.kind
    return _known(accents, key, "accent").format(_say_node(node.base, lang))


@_say_node.register
def _say_fence(node: n.Fenced, lang: str) -> str:
    """Return what stands in brackets with the words for them; an interval by its bounds."""
    words = load_speech_words(lang)
    if node.kind in words.intervals and isinstance(node.body, n.MathRow):
        bounds = [_say_node(item, lang) for item in node.body.items if item != n.OperatorSign(",")]
        if len(bounds) == 2 and len(node.body.items) == 3:
            return words.intervals[node.kind].format(*bounds)
    long = node.kind + "…"
    key = long if long in words.brackets and not is_simple(node.body) else node.kind
    if key not in words.brackets and len(key) == len("()"):
        signs = ["" if one == "." else _known(words.brackets, one, "brackets") for one in key]
        return f"{signs[0]} {_say_node(node.body, lang)} {signs[1]}"
    return _known(words.brackets, key, "brackets").format(_say_node(node.body, lang))


@_say_node.register
def _say_function(node: n.Func, lang: str) -> str:
    """Return a function with its arguments, in the shortest form that is clear."""
    words = load_speech_words(lang)
    said = [_say_node(arg, lang) for arg in node.args]
    if not all(map(is_simple, node.args)) or not _is_plain_head(node.head):
        return words.long["func"].format(_say_function_head(node.head, lang), ", ".join(said))
    listed = ", ".join(said)
    if len(said) > 1:
        listed = words.short["last"].format(", ".join(said[:-1]), said[-1])
    if isinstance(node.head, n.Ident):
        return words.short["of"].format(_say_node(node.head, lang), listed)
    if isinstance(node.head, n.Scripts) and node.head.sup is not None:
        return words.short["apply"].format(_say_function_head(node.head, lang), listed)
    if isinstance(node.head, n.Scripts) and node.head.sub is not None:
        return words.short["base"].format(_say_node(node.head.sub, lang), listed)
    name = node.head.text if isinstance(node.head, n.Word) else ""
    if name not in words.functions:
        return words.short["of"].format(_say_node(node.head, lang), listed)
    return words.functions[name][0].format(listed)


def _is_plain_head(head: n.Node) -> bool:
    """Return whether a head is a bare function name, or a logarithm with its base."""
    if isinstance(head, n.Scripts):
        return (head.base == n.Word("log")) is (head.sub is not None)
    return isinstance(head, n.Word | n.Ident)


def _say_function_head(node: n.Node, lang: str) -> str:
    """Return a function's name alone, with its power or base."""
    words = load_speech_words(lang)
    if isinstance(node, n.FunctionName):
        return _say_function_head(n.Word(node.text), lang)
    if isinstance(node, n.Word):
        known = words.functions.get(node.text)
        return known[1] if known else _say_node(node, lang)
    return _say_scripted_head(node, lang) if isinstance(node, n.Scripts) else _say_node(node, lang)


def _say_scripted_head(node: n.Scripts, lang: str) -> str:
    """Return a function's name with base or power: ``log`` with 2, ``sin`` squared, inverse."""
    words = load_speech_words(lang)
    if node.sup == _MINUS_ONE:
        return words.powers["inverse"].format(_say_function_head(replace(node, sup=None), lang))
    if node.sup is not None:
        bare = n.Scripts(node.base, node.sub) if node.sub else node.base
        return _say_power(node, _say_function_head(bare, lang), lang)
    if node.sub is None:
        return _say_node(node, lang)
    if node.base == n.Word("log"):
        return words.short["base alone"].format(_say_node(node.sub, lang))
    return words.short["sub"].format(_say_function_head(node.base, lang), _say_node(node.sub, lang))


@_say_node.register
def _say_large_operator(node: n.LargeOperator, lang: str) -> str:
    """Return a sum, product or integral with its bounds."""
    what, low, high, closing = _known(load_speech_words(lang).signs, node.sign, "sign")
    said = [what]
    said += [low.format(_say_node(node.lower, lang))] if node.lower else []
    said += [high.format(_say_node(node.upper, lang))] if node.upper else []
    return " ".join([*said, closing])


@_say_node.register
def _say_under(node: n.Under, lang: str) -> str:
    """Return a function's name with what stands below it."""
    short = load_speech_words(lang).short
    if not isinstance(node.base, n.Word | n.FunctionName):
        return short["under"].format(_say_node(node.base, lang), _say_node(node.below, lang))
    key = "below" if node.base.text.startswith("lim") else "below over"
    return short[key].format(_say_function_head(node.base, lang), _say_node(node.below, lang))


@_say_node.register
def _say_over(node: n.Over, lang: str) -> str:
    """Return a sign and what stands above it in words; "!" above "=" reads "must equal"."""
    short = load_speech_words(lang).short
    if node == n.Over(n.OperatorSign("="), n.OperatorSign("!")):
        return short["must equal"]
    return short["over"].format(_say_node(node.base, lang), _say_node(node.above, lang))


@_say_node.register
def _say_brace(node: n.Brace, lang: str) -> str:
    """Return a body in words and, if its brace has one, the note."""
    said = _say_node(node.body, lang)
    if node.note is None:
        return said
    return load_speech_words(lang).long["brace"].format(said, _say_node(node.note, lang))


@_say_node.register
def _say_display(node: n.Display, lang: str) -> str:
    """Return a body in words; its size is not read out."""
    return _say_node(node.body, lang)


@_say_node.register
def _say_binomial(node: n.Binomial, lang: str) -> str:
    """Return a binomial coefficient in words."""
    return _say_phrase(lang, "binomial", (node.top, node.bottom))


@_say_node.register
def _say_cases(node: n.Cases, lang: str) -> str:
    """Return each branch with its condition, the last with the word for *otherwise*."""
    short = load_speech_words(lang).short
    rows = []
    for value, condition in node.rows:
        if condition is None:
            rows.append(short["otherwise"].format(_say_node(value, lang)))
        else:
            rows.append(short["case"].format(_say_node(value, lang), _say_node(condition, lang)))
    return "; ".join(rows)


@_say_node.register
def _say_matrix(node: n.Matrix, lang: str) -> str:
    """Return a matrix row by row, numbered from 1."""
    words = load_speech_words(lang)
    rows = [", ".join([_say_node(cell, lang) for cell in row]) for row in node.rows]
    said = [words.short["row"].format(f"{i}: {row}") for i, row in enumerate(rows, 1)]
    key = "determinant" if node.kind == "||" else "matrix"
    if all(len(row) == 1 for row in node.rows):
        return words.long["vector"].format(", ".join(rows))
    return words.long[key].format("; ".join(said))


@_say_node.register
def _say_aligned_rows(node: n.AlignedRows, lang: str) -> str:
    """Return lines one after the other; after a brace, a comma before each condition."""
    between = ", " if node.brace else " "
    rows = [between.join([_say_node(cell, lang) for cell in row]) for row in node.rows]
    return "; ".join(rows)
