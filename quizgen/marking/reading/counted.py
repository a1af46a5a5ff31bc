"""The counted thing beside a number: ``6 grey levels``, ``level 55``."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from functools import lru_cache

from quizgen.locale import in_letters_of, known
from quizgen.marking.reading.source import Source
from quizgen.maths.units import shown as shown_unit
from quizgen.maths.units import units_in_use

MOST_WORDS, LONGEST_WORD = 60, 60


def check_counted(words: list[str]) -> None:
    """Check the words for what is counted.

    Raises
    ------
    ValueError
        If one is empty or there are more than anyone means.
    """
    if len(words) > MOST_WORDS or not all(0 < len(word) <= LONGEST_WORD for word in words):
        raise ValueError(f"counts: at most {MOST_WORDS} words of 1 to {LONGEST_WORD} letters")


def without_counted(source: Source, words: Iterable[str]) -> Source:
    """Drop the word for what is counted, behind or before the number."""
    named = tuple(word for word in words if word not in units_in_use().simple) if words else ()
    if not named:
        return source
    behind, before = _patterns(named)
    match = behind.search(source.text)
    if match is not None:
        return source.cut(0, match.start())
    match = before.match(source.text)
    return source.cut(match.end()) if match is not None else source


def counted_unit(words: Iterable[str]) -> str:
    """The listed unit among the words for what is counted, or an empty text."""
    return next((word for word in words if word in units_in_use().simple), "")


def counted_name(words: list[str], lang: str) -> str:
    """What is counted, as it is called in a language."""
    if words[0] in units_in_use().simple:
        return shown_unit(words[0])
    return next((word for word in words if in_letters_of(known(lang), word)), words[0])


@lru_cache(maxsize=256)
def _patterns(words: tuple[str, ...]) -> tuple[re.Pattern[str], re.Pattern[str]]:
    longest_first = sorted(words, key=len, reverse=True)
    spelt = (re.escape(unicodedata.normalize("NFC", word)) for word in longest_first)
    listed = "|".join(spelt).replace("/", "/ ?")
    behind = re.compile(rf"(?<=[\d)%]) ?(?:{listed})$", re.IGNORECASE)
    return behind, re.compile(rf"(?:{listed}) ?(?=[-+]?[\d(])", re.IGNORECASE)
