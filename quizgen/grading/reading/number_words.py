"""Numbers written as words, and sums of several units: ``sixteen``, ``1 crore 10 lakh``."""

from __future__ import annotations

import re
from fractions import Fraction
from functools import cache

from quizgen.core.errors import FormulaError
from quizgen.grading.reading.units import TypedUnit, read_unit
from quizgen.locale import list_languages, load_words
from quizgen.maths.numbers import to_fraction


@cache
def list_number_words() -> dict[str, int]:
    """Return the words for whole numbers in every language, in small letters, to the number.

    Bangla ``নয়`` is nine and *not*: it counts only where nothing else stands before it.
    """
    words: dict[str, int] = {}
    for lang in list_languages():
        table = load_words(lang, "answers")["numbers"]
        words |= {word: place for place, word in enumerate(table["counted"])}
        words |= {
            word: int(value) for value, word in (one.split(" ", 1) for one in table["larger"])
        }
    ones = list(words.items())
    for tens, value in ones:
        if value not in range(20, 100, 10):
            continue
        for one, added in (pair for pair in ones if 0 < pair[1] < 10):
            words[f"{tens}-{one}"] = words[f"{tens} {one}"] = value + added
            words[f"{one.removesuffix('s') if one == 'eins' else one}und{tens}"] = value + added
    return words


@cache
def _compile_number_word_pattern() -> re.Pattern[str]:
    """Return the pattern of a number word at the start of a text, of any language."""
    longest_first = sorted(list_number_words(), key=len, reverse=True)
    listed = "|".join(map(re.escape, longest_first))
    return re.compile(rf"^(?:{listed})(?![\w\u0980-\u09ff])", re.IGNORECASE)


_NUMBER = r"(\d+(?:\.\d+)?)"


@cache
def _list_multiples() -> dict[str, int]:
    """Return the words that multiply the number before them, in small letters: lakh, thousand."""
    rows = [
        row.split(" ", 1)
        for lang in list_languages()
        for row in load_words(lang, "answers")["numbers"]["multiples"]
    ]
    return {word.lower(): int(size) for size, word in rows}


@cache
def _summand_pattern() -> re.Pattern[str]:
    """Return the pattern of ``10 lakh`` and what leads on to the next summand."""
    words = "|".join(map(re.escape, sorted(_list_multiples(), key=len, reverse=True)))
    return re.compile(
        rf"{_NUMBER} ?({words})(?![\w\u0980-\u09ff])(?: (?:and|und|ও) | |$)", re.IGNORECASE
    )


_REST = re.compile(r"\d{1,3}(?=$| )")
_PIECE = re.compile(rf"{_NUMBER} ?((?:[^\W\d]|[\u0980-\u09ff])+)(?:,? (?:and|und|ও|এবং) |,? |$)")


def replace_number_word(text: str) -> str:
    """Return ``ten bits`` as ``10 bits``; the text itself if it begins with no number word."""
    match = _compile_number_word_pattern().match(text)
    if match is None:
        return text
    value, rest = list_number_words()[match[0].lower()], text[match.end() :]
    hundreds = _HUNDRED.match(rest) if 0 < value < len("1234567890") else None
    if hundreds:
        value, rest = value * 100, rest[hundreds.end() :]
        more = _compile_number_word_pattern().match(rest)
        if more and list_number_words()[more[0].lower()] < 100:
            value, rest = value + list_number_words()[more[0].lower()], rest[more.end() :]
        else:
            rest = f" {rest}".rstrip()
    digits, rest = _read_spoken_decimals(rest)
    return f"{value}{digits}{rest}"


_HUNDRED = re.compile(r" hundred(?: and)?(?: |$)", re.IGNORECASE)
_POINT = re.compile(r" (?:point|komma|দশমিক) (?=[^\W\d])", re.IGNORECASE)


def _read_spoken_decimals(rest: str) -> tuple[str, str]:
    """Return the decimals of ``two point five six`` with their mark, and what follows them."""
    point = _POINT.match(rest)
    if point is None:
        return "", rest
    digits, left = "", rest[point.end() :]
    while (word := _compile_number_word_pattern().match(left)) is not None:
        digit = list_number_words()[word[0].lower()]
        if digit >= len("0123456789"):
            break
        digits, left = f"{digits}{digit}", left[word.end() :].lstrip(" ")
    return (f".{digits}", f" {left}".rstrip()) if digits else ("", rest)


def replace_only_number_word(text: str) -> str:
    """Return ``the blur is four pixels long`` with the digit; the text itself if it has not one.

    ``one`` and ``a`` are too often no number.
    """
    words = [
        match
        for match in re.finditer(r"[^\W\d_]+(?:-[^\W\d_]+)?", text)
        if list_number_words().get(match[0].lower(), 1) != 1
    ]
    if len(words) != 1 or not text[: words[0].start()].isascii():
        return text
    (only,) = words
    return f"{text[: only.start()]}{list_number_words()[only[0].lower()]}{text[only.end() :]}"


def add_large_words(text: str) -> str:
    """Return ``1 crore 10 lakh 59 thousand`` as one number; the text itself if no such sum."""
    found, position, last = Fraction(0), 0, 10**9
    count = 0
    while (match := _summand_pattern().match(text, position)) is not None:
        size = _list_multiples()[match[2].lower()]
        if size >= last:
            return text
        last = size
        found += Fraction(match[1]) * last
        position, count = match.end(), count + 1
    rest = _REST.match(text, position) if count else None
    if rest is not None and int(rest[0]) < last:
        found, position, count = found + int(rest[0]), rest.end(), count + 1
    if count < len(("one", "more")) or found.denominator != 1:
        return text
    return f"{found}{text[position:]}"


def add_mixed_units(text: str) -> str:
    """Return ``27 min 26 s`` in the last of its units; the text itself if no such sum.

    Each unit must be smaller than the one before it, and each value but the first less than one
    of the unit before.
    """
    pieces: list[tuple[Fraction, TypedUnit]] = []
    position = 0
    while (match := _PIECE.match(text, position)) is not None:
        try:
            pieces.append((Fraction(match[1]), read_unit(match[2])))
        except FormulaError:
            return text
        position = match.end()
    if position != len(text) or len(pieces) < len(("one", "more")):
        return text
    total = Fraction(0)
    unit = pieces[-1][1]
    before: Fraction | None = None
    for value, typed in pieces:
        factor = to_fraction(typed.factor / unit.factor)
        fits = before is None or (factor < before and value * factor < before)
        if typed.dimension != unit.dimension or not fits:
            return text
        total, before = total + value * factor, factor
    exact = total.numerator if total.denominator == 1 else total
    return f"{exact} {unit.text}"
