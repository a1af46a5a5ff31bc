"""Numbers as people say them: ``2 to the 4``, ``eine 125stel Sekunde``, ``208, not 464``.

Each is rewritten in the signs that the other readers know. What could be another number is left
as it was typed, so that it is asked back.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from functools import cache

from quizgen.core.errors import FormulaError
from quizgen.grading.reading.equalities import read_sides
from quizgen.grading.reading.factor_words import read_factor
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.units import read_unit
from quizgen.locale import list_languages, load_words
from quizgen.maths.notation import FormulaReadError

_END = r"(?![\w\u0980-\u09ff])"
_VALUE = r"[-+−]?[.,]?\d[\d.,/' ]*(?:(?<=\d)|(?<=\d[.,]))(?: ?[^\W\d][^\d\s,;:()]{0,14}|%)?"
_PLAIN = r"[-+−]?\d+(?:[.,]\d+)?"
_MOST_ERROR = 0.01
"""Relative error that a value may be said to have, and still be one value."""


@cache
def _list_phrases(section: str, name: str) -> tuple[str, ...]:
    """Return the words of one list, of all languages, as they stand, longest first."""
    found = [
        unicodedata.normalize("NFC", one)
        for lang in list_languages()
        for one in load_words(lang, "spoken")[section][name]
    ]
    return tuple(sorted(dict.fromkeys(found), key=len, reverse=True))


@cache
def _alternatives(section: str, name: str) -> str:
    """Return the words of one list as alternatives of a pattern."""
    return "|".join(map(re.escape, _list_phrases(section, name)))


@cache
def _compile(shape: str) -> re.Pattern[str]:
    """Return a pattern in which ``<powers to>`` stands for the words of a list."""
    filled = re.sub(r"<(\w+) (\w+)>", lambda m: f"(?:{_alternatives(m[1], m[2])})", shape)
    return re.compile(filled, re.IGNORECASE)


def write_spoken_value(text: str) -> str:
    """Return a number in words that mean a power, a share or a half in signs; else as it is."""
    text = _POINTLESS.sub("", _write_powers(text))
    if not text.endswith("/"):
        text = _compile(
            rf"(?<![\w./⁄])(?:<shares one> )?(\d+)(?: ?-?<shares endings>)(?![^\W\d_])"
        ).sub(r"1/\1", text)
    halves = _compile(rf"(?<=\d)( <mixed half>){_END}")
    text = re.sub(r"(\d+)\.5\.5", r"\1.5", halves.sub(".5", text))
    text = _compile(r"(?<![\d.,])(\d+) <mixed joint> (?=\d+ ?/ ?\d)").sub(r"\1 ", text)
    for row in _list_phrases("mixed", "words"):
        value, _, words = row.partition(" ")
        text = re.sub(rf"(?<![\w\u0980-\u09ff]){re.escape(words)}{_END}", value, text, flags=re.I)
    return _write_share(text)


_POINTLESS = re.compile(r"(?<=\S) *(?::-?\)+|;-?\)|:-?D|:P|\^\^|\\)$")
"""Smileys, and a stroke that a keyboard left behind."""


def _write_powers(text: str) -> str:
    """Return ``2 hoch 4`` as ``2^(4)``, ``3 mal 10 hoch minus 2`` as ``3*10^(-2)``."""
    power = _compile(rf"(?<=[\d)]) <powers to> (?:(-|−)|(<powers minus>) )?(\d+){_END}")
    text = power.sub(lambda m: f"^({'-' if m[1] or m[2] else ''}{m[3]})", text)
    return _compile(r"(?<=\d) <powers times> (?=10 ?\^)").sub("*", text)


def _write_share(text: str) -> str:
    """Return ``ein Drittel Blende`` as ``1/3 Blende``, and ``one fifth`` as ``1/5``."""
    if any(map(str.isdigit, text)):
        return text
    share = read_factor(text)
    if share.startswith("1/(") or "/" in share:
        return share.replace("(", "").replace(")", "")
    before, _, last = text.strip(" .").rpartition(" ")
    share = read_factor(before) if before else ""
    return f"{share} {last}" if "/" in share and "(" not in share and _is_unit(last) else text


def _is_unit(text: str) -> bool:
    """Return whether a text is a listed unit."""
    try:
        read_unit(text)
    except FormulaError:
        return False
    return True


def list_meant_values(text: str) -> Iterator[str]:
    """Yield the one value that a text with several numbers means.

    That is the one which another is said not to be, one that is said twice in other units or
    forms, or one with its error.
    """
    for shape in _list_contrasts():
        match = shape.fullmatch(text.strip(" .!"))
        if match:
            yield match["right"]
            return
    yield from _read_same_twice(text)
    around = _ERROR.fullmatch(text.strip())
    if around and _is_small_error(around):
        yield f"{around['value']} {around['unit'] or around['last'] or ''}".strip()
    parted = _PARTED_UNIT.fullmatch(text)
    if parted and _is_unit(parted[2]):
        yield f"{parted[1]} {parted[2]}"


_ERROR = re.compile(
    rf"\(?(?P<value>{_PLAIN}) ?(?P<unit>[^\W\d_]+(?:/[^\W\d_]+)?)? ?(?:±|\+ ?/? ?[-−]) ?"
    rf"(?P<error>\d+(?:[.,]\d+)?)\)? ?(?P<last>[^\W\d_]+(?:/[^\W\d_]+)?|[%°])?"
)
_PARTED_UNIT = re.compile(r"(.*\d)(?: ?[,;_] ?| ?[-–] ?)([^\W\d_][^\d\s]*|[%°])")


def _is_small_error(match: re.Match[str]) -> bool:
    """Return whether an error is small beside its value, and in the same unit."""
    value, error = (abs(float(match[part].replace(",", ".").replace("−", "-"))) for part in ("value", "error"))
    units = {match["unit"] or match["last"], match["last"] or match["unit"]}
    return error <= _MOST_ERROR * value and len(units) == 1


@cache
def _list_contrasts() -> tuple[re.Pattern[str], ...]:
    """Return the patterns of sentences that say which of two values is meant."""
    return tuple(
        re.compile(
            sentence.replace("{wrong}", f"(?:{_VALUE})").replace("{right}", f"(?P<right>{_VALUE})"),
            re.IGNORECASE,
        )
        for sentence in _list_phrases("contrast", "sentences")
    )


def _read_same_twice(text: str) -> Iterator[str]:
    """Yield ``1/125 s = 8 ms`` for ``1/125 s or 8 ms``, if both are one value said differently."""
    match = _compile(rf"({_VALUE})[, ]*\(?(?<=[ ,(])<same between>,? ({_VALUE})\)?").fullmatch(text)
    if match is None or _form(match[1]) == _form(match[2]):
        return
    chain = f"{match[1].strip()} = {match[2].strip()}"
    try:
        read_sides(SourceText.of(chain), "auto")
    except FormulaReadError:
        return
    yield chain


def _form(value: str) -> tuple[bool, str]:
    """Return how a value is written: as a fraction or not, and with which unit."""
    return "/" in value, value.lstrip("-+−.,/' 0123456789").strip()


def find_given_value(text: str) -> str:
    """Return the value that a text leads to: ``4 bits give 16 levels``; empty if it is none."""
    match = _compile(rf".*\d.*(?<![\w\u0980-\u09ff])<giving words>:? ({_VALUE}(?: [^\W\d]+)?)").fullmatch(text)
    if match:
        return match[1]
    led = _LED.fullmatch(text)
    return led[1] if led else ""


_LED = re.compile(rf"[^=:]*[^\W\d][^=:]*\d[^=:]*: ({_VALUE})|{_PLAIN} ?(?:→|->|=>|⇒) ?({_VALUE})")


def list_power_readings(typed: str) -> tuple[str, str] | None:
    """Return both readings of ``1.085*10-2`` and ``1.085x103``, whose exponent was not raised."""
    match = _LOST.fullmatch(typed.strip())
    if match is None:
        return None
    head, sign, digits, unit = match.groups()
    plain = f"{head}·10 − {digits}" if sign else f"{head}·10{digits}"
    power = f"{head}·10^{'-' if sign else ''}{digits}"
    return f"{plain} {unit}".strip(), f"{power} {unit}".strip()


_LOST = re.compile(
    r"([-+−]?\d+(?:[.,]\d+)?) ?[*xX×·] ?10 ?([-−–]?) ?(\d{1,2})( ?[^\W\d_][^\d]*|)"
)
