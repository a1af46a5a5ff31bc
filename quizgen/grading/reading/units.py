"""Reading typed units: spellings in English, German and Bangla, and compound units."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping
from functools import cache, lru_cache
from typing import Any, NamedTuple

import msgspec
from flint import arb

from quizgen.core.errors import FormulaError
from quizgen.maths.numbers import to_rational
from quizgen.maths.precision import working_precision
from quizgen.maths.units import SIMPLE, Unit, UnitRegistry, active_units

WORDS = {
    "pixel": "px",
    "pixels": "px",
    "pix": "px",
    "পিক্সেল": "px",
    "megapixel": "Mpx",
    "megapixels": "Mpx",
    "MP": "Mpx",
    "metre": "m",
    "metres": "m",
    "meter": "m",
    "meters": "m",
    "মিটার": "m",
    "মি": "m",
    "millimetre": "mm",
    "millimetres": "mm",
    "millimeter": "mm",
    "millimeters": "mm",
    "মিলিমিটার": "mm",
    "মিমি": "mm",
    "centimetre": "cm",
    "centimetres": "cm",
    "centimeter": "cm",
    "centimeters": "cm",
    "সেন্টিমিটার": "cm",
    "সেমি": "cm",
    "kilometre": "km",
    "kilometres": "km",
    "kilometer": "km",
    "kilometers": "km",
    "কিলোমিটার": "km",
    "কিমি": "km",
    "micrometre": "um",
    "micrometres": "um",
    "micrometer": "um",
    "micrometers": "um",
    "micron": "um",
    "microns": "um",
    "mikrometer": "um",
    "মাইক্রোমিটার": "um",
    "মাইক্রন": "um",
    "nanometre": "nm",
    "nanometres": "nm",
    "nanometer": "nm",
    "nanometers": "nm",
    "ন্যানোমিটার": "nm",
    "second": "s",
    "seconds": "s",
    "sec": "s",
    "secs": "s",
    "sekunde": "s",
    "sekunden": "s",
    "সেকেন্ড": "s",
    "millisecond": "ms",
    "milliseconds": "ms",
    "msec": "ms",
    "millisekunden": "ms",
    "মিলিসেকেন্ড": "ms",
    "microsecond": "us",
    "microseconds": "us",
    "মাইক্রোসেকেন্ড": "us",
    "degree": "deg",
    "degrees": "deg",
    "grad": "deg",
    "ডিগ্রি": "deg",
    "ডিগ্রী": "deg",
    "radian": "rad",
    "radians": "rad",
    "রেডিয়ান": "rad",
    "stops": "stop",
    "blende": "stop",
    "blenden": "stop",
    "blendenstufe": "stop",
    "blendenstufen": "stop",
    "স্টপ": "stop",
    "decibel": "dB",
    "decibels": "dB",
    "ডেসিবেল": "dB",
    "lux": "lx",
    "লাক্স": "lx",
    "lumen": "lm",
    "lumens": "lm",
    "লুমেন": "lm",
    "watt": "W",
    "watts": "W",
    "ওয়াট": "W",
    "hertz": "Hz",
    "হার্টজ": "Hz",
    "electronvolt": "eV",
    "electronvolts": "eV",
    "bits": "bit",
    "বিট": "bit",
    "byte": "B",
    "bytes": "B",
    "বাইট": "B",
    "percent": "%",
    "per cent": "%",
    "prozent": "%",
    "শতাংশ": "%",
    "electron": "e-",
    "electrons": "e-",
    "elektronen": "e-",
    "ইলেকট্রন": "e-",
    "photons": "photon",
    "photonen": "photon",
    "ফোটন": "photon",
    "rows": "row",
    "zeilen": "row",
    "সারি": "row",
    "frames": "frame",
    "ফ্রেম": "frame",
    "ADU": "DN",
    "fps": "frame/s",
    "line pairs": "lp",
    "linienpaare": "lp",
    "LP": "lp",
    "Lp": "lp",
    "Lux": "lx",
    "LUX": "lx",
    "Sek": "s",
    "sek": "s",
    "সে": "s",
    "f-stop": "stop",
    "f-stops": "stop",
    "f/stops": "stop",
    "pct": "%",
    "v. H": "%",
    "শতকরা": "%",
    "পারসেন্ট": "%",
    "dpt": "1/m",
    "D": "1/m",
    "diopter": "1/m",
    "diopters": "1/m",
    "dioptre": "1/m",
    "dioptres": "1/m",
    "dioptrie": "1/m",
    "dioptrien": "1/m",
    "ডায়াপ্টার": "1/m",
    "bild": "frame",
    "bilder": "frame",
}
"""Spelling (any case when it is longer than three letters) to a listed unit."""

_LARGE = {
    "k": ("kilo", "কিলো"),
    "M": ("mega", "মেগা"),
    "G": ("giga", "গিগা"),
}
_SMALL = {
    "m": ("milli", "মিলি"),
    "u": ("micro", "mikro", "মাইক্রো"),
    "n": ("nano", "ন্যানো"),
}
_STEMS = {
    "B": ("byte", "bytes", "বাইট"),
    "bit": ("bit", "bits", "বিট"),
    "px": ("pixel", "pixels", "pix", "পিক্সেল"),
    "Hz": ("hertz", "হার্টজ"),
    "W": ("watt", "watts", "ওয়াট"),
    "lx": ("lux", "লাক্স"),
    "lm": ("lumen", "lumens", "লুমেন"),
    "s": ("second", "seconds", "sekunde", "sekunden", "সেকেন্ড"),
}


def _iter_prefixed_words(
    stems: Mapping[str, tuple[str, ...]], simple: Container[str]
) -> Iterator[tuple[str, str]]:
    """``megabytes`` and ``MBytes``: every prefix a unit may have, before every word for it."""
    for listed, words in stems.items():
        for letter, spoken in (_LARGE | _SMALL).items():
            if letter + listed in simple:
                yield from ((f"{p}{word}", letter + listed) for p in spoken for word in words)
            if letter in _LARGE and letter + listed in simple:
                yield from ((letter + word, letter + listed) for word in words)
                yield from ((letter + word.capitalize(), letter + listed) for word in words)


WORDS = {**dict(_iter_prefixed_words(_STEMS, SIMPLE)), **WORDS}


class _Spellings(NamedTuple):
    """Words for units: as they are written, and in small letters where they are long enough."""

    written: Mapping[str, str]
    lower: Mapping[str, str]


@cache
def _build_unit_spellings(known: UnitRegistry) -> _Spellings:
    """The words for the listed units, and for those that a bank defines."""
    own = {word: symbol for symbol, words in known.words.items() for word in words}
    words = {**dict(_iter_prefixed_words(known.words, known.simple)), **own, **WORDS}
    return _Spellings(words, {word.lower(): to for word, to in words.items() if len(word) > 3})


_POINTS = re.compile(r"\. ?")
_BRACKETS = re.compile(r"[(\[]([^()\[\]*/· ]+)[)\]]")
_SQUARE = re.compile(r"(?:square |quadrat|বর্গ ?)([^\W\d_][^*/· ]*)", re.IGNORECASE)
_PART = re.compile(r"[*/·]|[^*/·]+")


class TypedUnit(msgspec.Struct, frozen=True):
    """A unit as typed: the listed spelling, its factor to base units and its dimension."""

    text: str
    factor: Any
    dimension: tuple[tuple[str, int], ...]


def listed_unit(listed: str) -> TypedUnit:
    """Look up a unit in use; ``rad`` counts as 180/π degrees."""
    return _get_listed_unit(active_units(), listed)


@lru_cache(maxsize=2048)
@working_precision()
def _get_listed_unit(known: UnitRegistry, listed: str) -> TypedUnit:
    if listed == "rad":
        return TypedUnit("rad", 180 / arb.pi(), (("deg", 1),))
    found: Unit = known.unit(listed)
    return TypedUnit(listed, to_rational(found.factor), found.dimension)


def _find_unit_word(word: str) -> str:
    """Return the listed name of one unit word.

    Raises
    ------
    FormulaError
        If no unit is spelled like this.
    """
    word = word.strip().rstrip(".").strip()
    known = active_units()
    if word in known.simple or word == "rad":
        return word
    words, lower = _build_unit_spellings(known)
    listed = words.get(word) or lower.get(word.lower()) or words.get(_POINTS.sub("", word))
    if listed is None and word.startswith(("µ", "μ")):
        listed = "u" + word[1:] if "u" + word[1:] in known.simple else None
    if listed is None:
        raise FormulaError(f"unknown unit {word!r}")
    return listed


def read_unit(text: str) -> TypedUnit:
    """Read a typed unit such as ``mm``, ``Pixel``, ``µm/px``, ``lx s``, ``mm²``, ``1/mm``.

    Raises
    ------
    FormulaError
        If a name in it is not listed.
    """
    return _parse_typed_unit(active_units(), text.strip())


@lru_cache(maxsize=2048)
def _parse_typed_unit(_known: UnitRegistry, text: str) -> TypedUnit:
    try:
        return listed_unit(_find_unit_word(text))
    except FormulaError:
        compound = _parse_compound_unit(text)
    return listed_unit(compound)


def _parse_compound_unit(text: str) -> str:
    text = _BRACKETS.sub(r"\1", text)
    if (text[:1], text[-1:]) in {("(", ")"), ("[", "]")} and text.count(text[0]) == 1:
        text = text[1:-1]
    text = re.sub(r"^(?:per|pro)\s+", "1/", text)
    text = re.sub(r"\s+(?:per|pro)\s+|\s*প্রতি\s*", "/", text)
    text = re.sub(r" *([*/·]) *", r"\1", text)
    text = _SQUARE.sub(r"\1^2", text)
    pieces = _PART.findall(text)
    return "".join(piece if piece in "*/·" else _parse_unit_product(piece) for piece in pieces)


def _parse_unit_product(piece: str) -> str:
    if piece == "1":
        return "1"
    try:
        return _find_unit_word(piece)
    except FormulaError:
        return "*".join(_parse_unit_power(word) for word in piece.split())


def _parse_unit_power(word: str) -> str:
    match = re.fullmatch(r"(.*?[^\d^(-])\^?\(?(-?[1-9])\)?", word)
    if match is None:
        return _find_unit_word(word)
    return f"{_find_unit_word(match[1])}^{match[2]}"


def suggest_unit(text: str) -> str:
    """Return a listed unit that differs from an unknown word in case only, or an empty text."""
    wanted = text.strip().lower()
    found = [name for name in active_units().simple if name.lower() == wanted and name]
    return min(found, key=lambda name: (name != wanted, name)) if found else ""
