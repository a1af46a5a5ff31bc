"""How units are printed: ``um^2/px`` as upright parts with exponents."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache, lru_cache
from typing import NamedTuple, TypeVar

import msgspec
from msgspec import Struct

from quizgen.core.decoding import convert
from quizgen.core.errors import QuizgenError, RenderError
from quizgen.locale import get_language, load_words
from quizgen.maths.notation.pretty import LOWERED
from quizgen.maths.units import SHOWN
from quizgen.typeset.nodes import Digits, Node, OperatorSign

TIGHT = frozenset({"deg", "°"})
"""Units set without a space after the number."""

_PART = re.compile(
    r"(?P<sign>[*/·]?)(?P<opening>\(?)(?P<name>[kMG]?e[-⁻]|[^*/·^⁻⁰-⁹²³()]+)"
    r"(?:\^?(?P<power>-?\d|⁻?[²³¹⁰⁴-⁹]))?(?P<closing>\)?)"
)


_NAME = re.compile(r"[^\W\d_]+|[kMG]?e-|°[CF]?|[%‰€$£৳1]")


class UnitPart(NamedTuple):
    """One simple unit: the sign before it, its listed name, how it is shown, its power.

    ``opening`` and ``closing`` are brackets around what is divided by: ``J/(mol·K)``.
    """

    sign: str
    name: str
    shown: str
    power: str
    opening: str = ""
    closing: str = ""


@lru_cache(maxsize=512)
def split_unit(text: str) -> tuple[UnitPart, ...]:
    """Return the simple parts of a unit, in order.

    Raises
    ------
    RenderError
        If a part is no name of a unit.
    """
    compact = text.replace(" ", "")
    found, position, within = list[UnitPart](), 0, False
    while position < len(compact):
        match = _PART.match(compact, position)
        listed = match["name"].replace("⁻", "-") if match else ""
        if match is None or not _NAME.fullmatch(listed):
            raise RenderError(f"no way to print the unit {text!r}")
        within = bool(match["opening"]) or within
        if (match["opening"] and match["sign"] != "/") or (match["closing"] and not within):
            raise RenderError(f"no way to print the unit {text!r}")
        sign = "/" if match["sign"] == "/" else "·" * bool(match["sign"])
        power = (match["power"] or "").translate(LOWERED)
        shown = SHOWN.get(listed, listed)
        found.append(UnitPart(sign, listed, shown, power, match["opening"], match["closing"]))
        position = match.end()
        within = within and not match["closing"]
    return tuple(found)


COMMA, SEMICOLON = OperatorSign(","), OperatorSign(";")


def list_separator(items: Sequence[Node], lang: str) -> OperatorSign:
    """Return the sign between items in a language: ``(1.5, 2)``, but ``(1,5; 2)``."""
    commas = get_language(lang).decimal == "," and any(map(_has_decimals, items))
    return SEMICOLON if commas else COMMA


def insert_separators(items: tuple[Node, ...], lang: str) -> tuple[Node, ...]:
    """Return the items of a row with the separators between them as a language has them."""
    if COMMA not in items or list_separator(items, lang) == COMMA:
        return items
    return tuple([SEMICOLON if item == COMMA else item for item in items])


def _has_decimals(node: object) -> bool:
    """Return whether a decimal stands anywhere in a node."""
    if isinstance(node, Digits):
        return "." in node.text
    if isinstance(node, tuple):
        return any(map(_has_decimals, node))
    if isinstance(node, Struct):
        return any(_has_decimals(getattr(node, name)) for name in node.__struct_fields__)
    return False


V = TypeVar("V")


def strict_lookup(medium: str) -> Callable[[Mapping[str, V], str, str], V]:
    """Return a look-up in a medium's tables that names what is missing.

    It raises RenderError where a table has no such key.
    """

    def look_up(table: Mapping[str, V], key: str, what: str) -> V:
        """Return the entry of a table, else raise RenderError with ``what`` is missing."""
        try:
            return table[key]
        except KeyError:
            raise RenderError(f"no {medium} for the {what} {key!r}") from None

    return look_up


class SpeechWords(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """How one language prints words in a formula and reads it aloud.

    Braces mark where the parts go, so the order of words is the language's own.
    """

    printed: dict[str, str]
    letters: dict[str, str]
    capital: str
    greek: dict[str, str]
    names: dict[str, str]
    operators: dict[str, str]
    brackets: dict[str, str]
    intervals: dict[str, str]
    functions: dict[str, tuple[str, str]]
    accents: dict[str, str]
    signs: dict[str, tuple[str, str, str, str]]
    powers: dict[str, str]
    raised: dict[str, str]
    short: dict[str, str]
    long: dict[str, str]
    prefixes: dict[str, str]
    units: dict[str, tuple[str, str]]
    unit_joints: dict[str, str]


@cache
def load_speech_words(lang: str) -> SpeechWords:
    """Return the words of a language, read once.

    Raises
    ------
    QuizgenError
        If there is no such language, or a table is missing in its file.
    """
    try:
        return convert(load_words(lang, "speech"), SpeechWords)
    except msgspec.ValidationError as error:
        raise QuizgenError(f"{lang}/speech.toml: {error}") from error
