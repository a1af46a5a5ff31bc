"""Numbers written as words, and sums of several units: ``sixteen``, ``1 crore 10 lakh``."""

from __future__ import annotations

import re
from fractions import Fraction

from quizgen.core.errors import FormulaError
from quizgen.grading.reading.units import TypedUnit, read_unit
from quizgen.locale import cache_words
from quizgen.locale.word_patterns import (
    WordPattern,
    list_rows,
    list_tables,
    list_words,
    set_of_words,
)
from quizgen.maths.numbers import to_fraction


@cache_words
def list_number_words() -> dict[str, int]:
    """Return the words for whole numbers in every language, in small letters, to the number.

    Bangla ``নয়`` is nine and *not*: it counts only where nothing else stands before it.
    """
    words: dict[str, int] = {}
    for table in list_tables("numbers"):
        own = {word: place for place, word in enumerate(table["counted"])}
        own |= {word: int(value) for value, word in (one.split(" ", 1) for one in table["larger"])}
        words |= own
        words |= {
            form.format(tens=tens, one=one): value + added
            for tens, value in own.items()
            if value in range(20, 100, 10)
            for one, added in own.items()
            if 0 < added < 10
            for form in table["tens-and-ones"]
        }
    return words


_NUMBER = r"(\d+(?:\.\d+)?)"


@cache_words
def list_multiples() -> dict[str, int]:
    """Return the words that multiply the number before them, in small letters: lakh, thousand."""
    hundreds = dict.fromkeys(list_words("numbers.hundred"), HUNDRED)
    return hundreds | {word.lower(): int(size) for size, word in list_rows("numbers.multiples")}


_SUMMAND = WordPattern(
    rf"{_NUMBER} ?(«numbers.multiples»|«numbers.hundred»)(?![\w\u0980-\u09ff])(?: «and» | |$)",
    re.IGNORECASE,
)
"""``10 lakh``, and what leads on to the next summand."""


_REST = re.compile(r"\d{1,3}(?=$| )")
_PIECE = WordPattern(rf"{_NUMBER} ?((?:[^\W\d]|[\u0980-\u09ff])+)(?:,? «and» |,? |$)")


def replace_number_word(text: str) -> str:
    """Return ``ten bits`` as ``10 bits``; the text itself if it begins with no number word."""
    found = _read_spoken_number(text)
    return f"{found[0]}{text[found[1] :]}" if found else text


_SPOKEN = WordPattern(
    r" ?-?(«numbers.larger»(?![-\w\u0980-\u09ff])|(?:[^\W\d_]|[\u0980-\u09ff])+)", re.IGNORECASE
)
"""One word, or several that are one number: ``quatre-vingt-dix``."""
_AND_A_HALF = WordPattern(r" «numbers.and-a-half»(?!\w)", re.IGNORECASE)
_POINT = WordPattern(r"(?:^| )«point» (?=[^\W\d])", re.IGNORECASE)


def _read_spoken_number(text: str) -> tuple[str, int] | None:
    """Return the number in words at the start of a text as digits, and where its words end."""
    value, end = _read_spoken_whole(text)
    if value is None and not (_POINT.match(text) and " " not in text[:1]):
        return None
    digits, end = _read_spoken_decimals(text, end)
    half = None if digits or value is None else _AND_A_HALF.match(text, end)
    if half:
        digits, end = ".5", half.end()
    return (f"{value or 0}{digits}", end) if digits or value is not None else None


def _read_spoken_whole(text: str) -> tuple[int | None, int]:
    """Return the whole number in words at the start of a text, and where its words end.

    A group below a thousand is read word by word; ``thousand`` and its like close it. What does
    not go on with the number ends it: of ``six seven`` only the first is read.
    """
    closed, group, last = 0, None, 10**15
    position = end = 0
    while (match := _SPOKEN.match(text, position)) is not None:
        word, position = match[1].lower(), match.end()
        size, one = list_multiples().get(word, 0), _find_spoken_word(word)
        if (
            word in set_of_words("numbers.a")
            and group is None
            and _is_multiple_next(text, position)
        ):
            group = 1
        elif size == HUNDRED and group and group < HUNDRED:
            group *= HUNDRED
        elif size > HUNDRED and size < last and group != 0:
            closed, group, last = closed + (group or 1) * size, None, size
        elif one is not None and (group is None or _goes_on(group, one)):
            group = (group or 0) + one
        elif word in set_of_words("and") and end:
            continue
        else:
            break
        end = position
    return (closed + (group or 0) if end else None), end


HUNDRED = 100


def _goes_on(group: int, one: int) -> bool:
    """Return whether a word may follow in a group: ``seven`` after ``hundred`` or ``twenty``."""
    if group >= HUNDRED and group % HUNDRED == 0:
        return 0 < one < HUNDRED
    return group % HUNDRED in range(20, 100, 10) and one in range(1, 10)


def _is_multiple_next(text: str, position: int) -> bool:
    """Return whether the next word multiplies, as after ``a`` in ``a hundred``."""
    match = _SPOKEN.match(text, position)
    return match is not None and match[1].lower() in list_multiples()


@cache_words
def _list_joints() -> tuple[tuple[str, int], ...]:
    """Return the words that multiply within one word, such as ``tausend``, the largest first."""
    rows = list_rows("numbers.inside")
    sizes = ((word, int(size)) for size, word in rows if size.isdecimal())
    return tuple(sorted(sizes, key=lambda one: -one[1]))


def _find_spoken_word(word: str) -> int | None:
    """Return the number of one word, also of a German compound; None if it is none."""
    known = list_number_words().get(word)
    if known is not None:
        return known
    for joint, size in _list_joints():
        before, found, behind = word.partition(joint)
        if not found:
            continue
        times = _find_spoken_word(before) if before else 1
        joined = next((one for one in list_words("and") if behind.startswith(one)), "")
        rest = _find_spoken_word(behind.removeprefix(joined)) if behind else 0
        return None if times is None or rest is None else times * size + rest
    return None


def _read_spoken_decimals(text: str, position: int) -> tuple[str, int]:
    """Return the decimals of ``two point five six`` with their mark, and where they end.

    A number of two digits is read as they are: ``null Komma fünfundzwanzig``.
    """
    point = _POINT.match(text, position) if position else _POINT.match(text)
    if point is None:
        return "", position
    digits, end, at = "", position, point.end()
    while (match := _SPOKEN.match(text, at)) is not None:
        one = _find_spoken_word(match[1].lower())
        if one is None or one >= HUNDRED or (digits and one >= len("0123456789")):
            break
        digits, at = f"{digits}{one}", match.end()
        end = at
    return (f".{digits}", end) if digits else ("", position)


def replace_only_number_word(text: str) -> str:
    """Return ``the blur is four pixels long`` with the digit; the text itself if it has not one.

    ``one`` and ``a`` are too often no number.
    """
    found, position = [], 0
    while (word := _SPOKEN_ANYWHERE.search(text, position)) is not None:
        number = _read_spoken_number(text[word.start() :])
        position = word.end()
        if number and number[0] != "1":
            position = word.start() + number[1]
            found.append((word.start(), position, number[0]))
    if len(found) != 1 or not text[: found[0][0]].isascii():
        return text
    ((start, end, digits),) = found
    return f"{text[:start]}{digits}{text[end:]}"


def replace_mixed_words(text: str) -> str:
    """Return ``three hours five minutes`` with digits; the text itself if it is no such sum."""
    spoken, position = "", 0
    while (word := _SPOKEN_ANYWHERE.search(text, position)) is not None:
        number = _read_spoken_number(text[word.start() :])
        end = word.start() + number[1] if number else word.end()
        spoken += text[position : word.start()] + (number[0] if number else word[0])
        position = end
    spoken += text[position:]
    return spoken if add_mixed_units(spoken) != spoken else text


_SPOKEN_ANYWHERE = re.compile(r"(?<![\w\u0980-\u09ff])[^\W\d_](?:[^\W\d_]|[\u0980-\u09ff])*")


def add_large_words(text: str) -> str:
    """Return ``1 crore 10 lakh 59 thousand`` as one number; the text itself if no such sum."""
    found, position, last = Fraction(0), 0, 10**9
    count = 0
    while (match := _SUMMAND.match(text, position)) is not None:
        size = list_multiples()[match[2].lower()]
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
