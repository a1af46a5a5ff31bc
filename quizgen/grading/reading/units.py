"""Reading typed units: spellings in English, German and Bangla, and compound units."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping
from functools import lru_cache, partial
from typing import Any, NamedTuple

import msgspec
from flint import arb, fmpq

from quizgen.core.errors import FormulaError
from quizgen.grading.judging.spelling import typo_distance
from quizgen.locale import FIRST, cache_words, list_languages, load_words
from quizgen.locale.word_patterns import WordPattern, list_tables
from quizgen.maths.numbers import to_rational
from quizgen.maths.precision import working_precision
from quizgen.maths.units import Unit, UnitRegistry, active_units

ELECTRON_VOLT = fmpq(1602176634, 10**28)
"""Joules in one electron volt, exactly so by definition."""
_JOULE = {"kg": 1, "m": 2, "s": -2}
_LARGE = "kMGT"
"""Prefixes that are written before a word as well: ``MBytes``."""
_NO_UNIT = {"", "1"}


def _iter_spoken_words(simple: Container[str]) -> Iterator[tuple[str, str]]:
    """Yield each word for a unit as it is read aloud, in every language, and its listed name.

    Words with prefixes are among them.
    """
    for lang in list_languages():
        words = load_words(lang, "speech")
        for listed, spoken in words["units"].items():
            if listed not in simple or listed in _NO_UNIT:
                continue
            for word in {*spoken, *(one.lower() for one in spoken)}:
                yield word, listed
            for letter, pattern in words["prefixes"].items():
                if letter + listed in simple:
                    for word in spoken:
                        yield pattern.format(word.lower()), letter + listed
        yield from _iter_prefixed_words({n: tuple(w) for n, w in words["units"].items()}, simple)


def _iter_prefixed_words(
    stems: Mapping[str, tuple[str, ...]], simple: Container[str]
) -> Iterator[tuple[str, str]]:
    """Yield ``MBytes`` and ``kBit``, a prefix letter and a word, and the listed name of each."""
    for listed, words in stems.items():
        for letter in _LARGE:
            if letter + listed in simple:
                yield from ((letter + word, letter + listed) for word in words)
                yield from ((letter + word.capitalize(), letter + listed) for word in words)


def _iter_bank_words(known: UnitRegistry) -> Iterator[tuple[str, str]]:
    """Yield each word for a unit that a bank defines, with English prefixes, and its symbol."""
    prefixes = load_words(FIRST, "speech")["prefixes"]
    for symbol, words in known.words.items():
        for letter, pattern in prefixes.items():
            if letter + symbol in known.simple:
                yield from ((pattern.format(word), letter + symbol) for word in words)
        yield from ((word, symbol) for word in words)


class _Spellings(NamedTuple):
    """Words for units: as they are written, and in small letters where they are long enough."""

    written: Mapping[str, str]
    lower: Mapping[str, str]


@cache_words
def list_unit_words() -> dict[str, str]:
    """Return abbreviations and other spellings of units, of every language, with the listed unit.

    What units are called in full stands in ``speech.toml`` of each language.
    """
    return {word: unit for table in list_tables("unit-words") for word, unit in table.items()}


@cache_words
def _build_unit_spellings(known: UnitRegistry) -> _Spellings:
    """Return the words for the listed units, and for those that a bank defines."""
    words = {
        **dict(_iter_spoken_words(known.simple)),
        **dict(_iter_prefixed_words(known.words, known.simple)),
        **dict(_iter_bank_words(known)),
        **list_unit_words(),
    }
    return _Spellings(words, {word.lower(): to for word, to in words.items() if len(word) > 3})


_POINTS = re.compile(r"\. ?")
_BRACKETS = re.compile(r"[(\[]([^()\[\]*/· ]+)[)\]]")
_SQUARE = WordPattern(r"«square»([^\W\d_][^*/· ]*)", re.IGNORECASE)
_SQUARED = WordPattern(r"([^\W\d_]+) «squared»", re.IGNORECASE)
_ONE_PER = WordPattern(r"^«per»\s+")
_PER = WordPattern(r"\s+«per»\s+|\s*«per-joined»\s*")
_PART = re.compile(r"[*/·]|[^*/·]+")


class TypedUnit(msgspec.Struct, frozen=True):
    """A unit as typed: the listed spelling, its factor to base units and its dimension."""

    text: str
    factor: Any
    dimension: tuple[tuple[str, int], ...]


def listed_unit(listed: str) -> TypedUnit:
    """Return a unit in use with its factor to base units; a radian is 180/π degrees.

    Raises
    ------
    FormulaError
        If it is not listed.
    """
    return _get_listed_unit(active_units(), listed)


@lru_cache(maxsize=2048)
@working_precision()
def _get_listed_unit(known: UnitRegistry, listed: str) -> TypedUnit:
    """Return a unit of a registry with factor and dimension: angles in degrees, energies in J."""
    found: Unit = known.unit(listed)
    factor, powers = to_rational(found.factor), dict(found.dimension)
    turned = powers.pop("rad", 0)
    if turned:  # the registry keeps the two apart, since their ratio is not rational
        factor = factor * (180 / arb.pi()) ** turned
        powers["deg"] = powers.get("deg", 0) + turned
    charged = powers.pop("eV", 0)
    factor = factor * ELECTRON_VOLT**charged
    for base, power in _JOULE.items() if charged else ():
        powers[base] = powers.get(base, 0) + power * charged
    return TypedUnit(listed, factor, tuple(sorted((b, p) for b, p in powers.items() if p)))


def _find_unit_word(word: str) -> str:
    """Return the listed name of one unit word.

    Raises
    ------
    FormulaError
        If no unit is spelled like this.
    """
    word = word.strip().rstrip(".").strip()
    known = active_units()
    if word in known.simple:
        return word
    words, lower = _build_unit_spellings(known)
    listed = words.get(word) or lower.get(word.lower()) or words.get(_POINTS.sub("", word))
    if listed is None and word.startswith(("µ", "μ")):
        listed = "u" + word[1:] if "u" + word[1:] in known.simple else None
    listed = listed or _find_parted_prefix(word, words, known.simple)
    listed = listed or _find_misspelt_unit(word, lower)
    if listed is None:
        raise FormulaError(f"unknown unit {word!r}")
    return listed


def _find_parted_prefix(word: str, words: Mapping[str, str], simple: Container[str]) -> str | None:
    """Return the unit of ``milli eV``, whose prefix is a word of its own; None if it has none."""
    prefix, _, rest = word.partition(" ")
    letter = _list_prefix_words().get(prefix.lower()) if rest and " " not in rest else None
    unit = rest if rest in simple else words.get(rest, "")
    return letter + unit if letter and unit and letter + unit in simple else None


@cache_words
def _list_prefix_words() -> Mapping[str, str]:
    """Return the words for prefixes in every language, and their letters."""
    return {
        pattern.format("").lower(): letter
        for lang in list_languages()
        for letter, pattern in load_words(lang, "speech")["prefixes"].items()
    }


def _find_misspelt_unit(word: str, known: Mapping[str, str]) -> str | None:
    """Return the one unit whose full name is a slip away, ``milimeter``; None if it is not one.

    A prefix is no slip: a letter that is left out, doubled or exchanged with its neighbour is.
    """
    small = word.lower()
    if len(small) < _LONG_WORD or not small.isalpha():
        return None
    found = {
        to
        for name, to in known.items()
        if abs(len(name) - len(small)) <= 1 and typo_distance(small, name, 1) == 1
    }
    return found.pop() if len(found) == 1 else None


_LONG_WORD = 6
"""Letters of a unit's name in which a slip of spelling is understood."""


def read_unit(text: str) -> TypedUnit:
    """Return a typed unit such as ``mm``, ``Pixel``, ``µm/px``, ``lx s``, ``mm²``, ``1/mm``.

    Raises
    ------
    FormulaError
        If a name in it is not listed.
    """
    return _parse_typed_unit(active_units(), _MU.sub("µ", _INTO.sub(r"\1", text.strip())))


def part_joined_units(typed: str, listed: str) -> str:
    """Return an answer with ``Nm`` as ``N*m`` where a unit with that product, or like it, is asked.

    Only products in the unit that is asked are looked for, and common ones of its kind; none that
    is a unit itself.
    """
    wanted = listed_unit(listed).dimension
    alike = [product for product in _COMMON if listed_unit(product).dimension == wanted]
    for product in dict.fromkeys((*_PRODUCTS.findall(listed), *alike)):
        joined = product.replace("*", "")
        if joined not in active_units().simple:
            pattern = rf"(?<![^\W\d_])([kMGmµcd]?){joined}(?![^\W_])"
            typed = re.sub(rf"/ ?{pattern}", rf"/(\g<1>{product})", typed)
            typed = re.sub(pattern, rf"\g<1>{product}", typed)
    return typed


_COMMON = ("N*m", "W*s", "V*s", "A*s", "V*A", "ohm*m", "N*s", "kg*m")
_PRODUCTS = re.compile(r"[^\W\d_]+(?:\*[^\W\d_]+)+")
_MU = WordPattern(r"^«micro» ?(?=[ms]$)")
_INTO = WordPattern(r"^\(?«in» +([^()]+)\)?$")
"""The unit that a number is said to be in, ``(in degrees)``: no inch."""


@partial(cache_words, most=2048)
def _parse_typed_unit(_known: UnitRegistry, text: str) -> TypedUnit:
    """Return a typed unit, cached for each registry.

    Raises
    ------
    FormulaError
        If a name in it is not listed.
    """
    try:
        return listed_unit(_find_unit_word(text))
    except FormulaError:
        compound = _parse_compound_unit(text)
    return listed_unit(compound)


def _parse_compound_unit(text: str) -> str:
    """Return a compound unit in the spelling of the registry: ``lx s`` is ``lx*s``.

    Raises
    ------
    FormulaError
        If a name in it is not listed.
    """
    text = _BELOW.sub(_divide_by_each, text)
    text = _BRACKETS.sub(r"\1", text)
    if (text[:1], text[-1:]) in {("(", ")"), ("[", "]")} and text.count(text[0]) == 1:
        text = text[1:-1]
    text = _PER.sub("/", _ONE_PER.sub("1/", text))
    text = re.sub(r" *([*/·]) *", r"\1", text)
    text = _SQUARE.sub(r"\1^2", text.replace("**", "^"))
    text = _SQUARED.sub(r"\1^2", text)
    pieces = _PART.findall(text)
    return "".join(piece if piece in "*/·" else _parse_unit_product(piece) for piece in pieces)


_BELOW = re.compile(r"/ ?[(\[]([^()\[\]/]*[^()\[\]/\s][ *·][^()\[\]/]+)[)\]]")
"""A product below the bar: ``J/(kg K)``."""


def _divide_by_each(match: re.Match[str]) -> str:
    """Return ``/kg/K`` for ``/(kg K)``."""
    return "".join(f"/{part}" for part in re.split(r"[ *·]+", match[1].strip()))


def _parse_unit_product(piece: str) -> str:
    """Return one unit word, or several with blanks between them as a product."""
    if piece == "1":
        return "1"
    try:
        return _find_unit_word(piece)
    except FormulaError:
        return "*".join(_parse_unit_power(word) for word in piece.split())


def _parse_unit_power(word: str) -> str:
    """Return a unit with its exponent, if it has one: ``mm2`` is ``mm^2``."""
    match = re.fullmatch(r"(.*?[^\d^(-])\^?\(?(-?[1-9])\)?", word)
    if match is None:
        return _find_unit_word(word)
    return f"{_find_unit_word(match[1])}^{match[2]}"


def suggest_unit(text: str) -> str:
    """Return a listed unit that differs from an unknown word in case only, or an empty text."""
    wanted = text.strip().lower()
    found = [name for name in active_units().simple if name.lower() == wanted and name]
    return min(found, key=lambda name: (name != wanted, name)) if found else ""
