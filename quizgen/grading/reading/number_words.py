"""Numbers written as words, and sums of several units: ``sixteen``, ``1 crore 10 lakh``."""

from __future__ import annotations

import re
from fractions import Fraction

from quizgen.core.errors import FormulaError
from quizgen.grading.reading.units import TypedUnit, read_unit
from quizgen.maths.numbers import to_fraction

_COUNTED = """
zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen \
sixteen seventeen eighteen nineteen twenty
null eins zwei drei vier fünf sechs sieben acht neun zehn elf zwölf dreizehn vierzehn fünfzehn \
sechzehn siebzehn achtzehn neunzehn zwanzig
শূন্য এক দুই তিন চার পাঁচ ছয় সাত আট নয় দশ এগারো বারো তেরো চৌদ্দ পনেরো ষোলো সতেরো আঠারো উনিশ বিশ
"""
"""A line for each language, counting from zero."""
_TENS = {
    "twenty": 20, "thirty": 30, "forty": 40, "fifty": 50, "sixty": 60, "seventy": 70,
    "eighty": 80, "ninety": 90, "hundred": 100, "a hundred": 100, "one hundred": 100,
    "zwanzig": 20, "dreißig": 30, "vierzig": 40, "fünfzig": 50, "sechzig": 60, "siebzig": 70,
    "achtzig": 80, "neunzig": 90, "hundert": 100, "einhundert": 100, "ein": 1, "eine": 1,
    "ষোল": 16, "কুড়ি": 20, "ত্রিশ": 30, "চল্লিশ": 40, "পঞ্চাশ": 50, "ষাট": 60, "সত্তর": 70,
    "আশি": 80, "নব্বই": 90, "একশ": 100, "একশো": 100,
}  # fmt: skip


def _build_number_words() -> dict[str, int]:
    """The words for whole numbers in every language, in small letters."""
    words = {
        word: place
        for listed in _COUNTED.strip().splitlines()
        for place, word in enumerate(listed.split())
    } | _TENS
    ones = list(words.items())
    for tens, value in ones:
        if value not in range(20, 100, 10):
            continue
        for one, added in (pair for pair in ones if 0 < pair[1] < 10):
            words[f"{tens}-{one}"] = words[f"{tens} {one}"] = value + added
            words[f"{one.removesuffix('s') if one == 'eins' else one}und{tens}"] = value + added
    return words


NUMBER_WORDS = _build_number_words()
"""Word for a whole number to the number; ``নয়`` is also *not* and stands only alone."""

_NUMBER_WORD = re.compile(
    r"^(?:{})(?![\w\u0980-\u09ff])".format(
        "|".join(re.escape(word) for word in sorted(NUMBER_WORDS, key=len, reverse=True))
    ),
    re.IGNORECASE,
)
_LARGE = (
    ("crores?|কোটি", 10**7),
    ("millions?|millionen|mio|মিলিয়ন", 10**6),
    ("lakhs?|lacs?|লাখ|লক্ষ", 10**5),
    ("thousand|tausend|হাজার", 10**3),
    ("hundred|hundert|শ|শত", 100),
)
_NUMBER = r"(\d+(?:\.\d+)?)"
_SUMMAND = re.compile(
    rf"{_NUMBER} ?(?:{'|'.join(f'({words})' for words, _ in _LARGE)})(?![\w\u0980-\u09ff])"
    r"(?: (?:and|und|ও) | |$)",
    re.IGNORECASE,
)
_REST = re.compile(r"\d{1,3}(?=$| )")
_PIECE = re.compile(rf"{_NUMBER} ?((?:[^\W\d]|[\u0980-\u09ff])+)(?:,? (?:and|und|ও|এবং) |,? |$)")


def replace_number_word(text: str) -> str:
    """``ten bits`` as ``10 bits``; the text itself if it begins with no word for a number."""
    match = _NUMBER_WORD.match(text)
    if match is None:
        return text
    return f"{NUMBER_WORDS[match[0].lower()]}{text[match.end() :]}"


def add_large_words(text: str) -> str:
    """``1 crore 10 lakh 59 thousand 200`` as one number; the text itself if it is no such sum."""
    found, position, last = Fraction(0), 0, 10**9
    count = 0
    while (match := _SUMMAND.match(text, position)) is not None:
        place = next(n for n in range(len(_LARGE)) if match[n + 2])
        if _LARGE[place][1] >= last:
            return text
        last = _LARGE[place][1]
        found += Fraction(match[1]) * last
        position, count = match.end(), count + 1
    rest = _REST.match(text, position) if count else None
    if rest is not None and int(rest[0]) < last:
        found, position, count = found + int(rest[0]), rest.end(), count + 1
    if count < len(("one", "more")) or found.denominator != 1:
        return text
    return f"{found}{text[position:]}"


def add_mixed_units(text: str) -> str:
    """``27 min 26 s`` in the last of its units; the text itself if it is no such sum.

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
