"""The counted thing beside a number: ``6 grey levels``, ``level 55``."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from functools import lru_cache

from quizgen.grading.judging.spelling import find_translation, fold_word
from quizgen.grading.reading.source_map import SourceText
from quizgen.locale import fallback_language, is_written_in
from quizgen.maths.units import active_units, format_unit

MOST_WORDS, LONGEST_WORD = 60, 60


def check_count_nouns(words: list[str]) -> None:
    """Check the words for what is counted.

    Raises
    ------
    ValueError
        If one is empty or there are more than anyone means.
    """
    if len(words) > MOST_WORDS or not all(0 < len(word) <= LONGEST_WORD for word in words):
        raise ValueError(f"counts: at most {MOST_WORDS} words of 1 to {LONGEST_WORD} letters")


def drop_count_noun(source: SourceText, words: Iterable[str]) -> SourceText:
    """Return a number without the word for what is counted, behind or before it."""
    named = tuple(word for word in words if word not in active_units().simple) if words else ()
    if not named:
        return source
    behind, before = _build_count_noun_patterns(named)
    match = behind.search(source.text)
    if match is not None:
        return source.slice(0, match.start())
    match = before.match(source.text)
    if match is not None:
        return source.slice(match.end())
    noun = _NOUN.search(source.text)
    said = {fold_word(word) for word in find_translation(noun[1])} if noun else set()
    meant = noun and said & {fold_word(word) for word in named}
    return source.slice(0, noun.start()) if noun and meant else source


def drop_count_nouns(source: SourceText, words: Iterable[str]) -> SourceText:
    """Return a chain without the words for what is counted: ``4.17 -> level 4``."""
    named = tuple(word for word in words if word not in active_units().simple)
    if not named:
        return source
    behind, before = _build_chain_patterns(named)
    return source.substitute(behind, lambda _m: "").substitute(before, lambda m: m[1])


_NOUN = re.compile(r"(?<=\d) ([^\W\d_]{3,})$")


def count_noun_unit(words: Iterable[str]) -> str:
    """Return the listed unit among the words for what is counted, or an empty text."""
    return next((word for word in words if word in active_units().simple), "")


def count_noun_name(words: list[str], lang: str) -> str:
    """Return what is counted, as it is called in a language."""
    if words[0] in active_units().simple:
        return format_unit(words[0])
    return next((word for word in words if is_written_in(fallback_language(lang), word)), words[0])


@lru_cache(maxsize=256)
def _build_count_noun_patterns(words: tuple[str, ...]) -> tuple[re.Pattern[str], re.Pattern[str]]:
    """Return the patterns of the words behind and before a number, cached for each question."""
    listed = _list_alternatives(words)
    behind = re.compile(rf"(?<=[\d)%]) ?(?:{listed})$", re.IGNORECASE)
    return behind, re.compile(rf"(?:{listed}) ?(?=[-+]?[\d(])", re.IGNORECASE)


@lru_cache(maxsize=256)
def _build_chain_patterns(words: tuple[str, ...]) -> tuple[re.Pattern[str], re.Pattern[str]]:
    """Return the patterns of the words on a side of a chain, cached for each question."""
    listed = _list_alternatives(words)
    behind = re.compile(rf"(?<=[\d)%]) ?(?:{listed})(?= *(?:[=≈→⇒]|->|$))", re.IGNORECASE)
    return behind, re.compile(rf"([=≈→⇒>] ?)(?:{listed}) ?(?=[-+]?[\d(])", re.IGNORECASE)


def _list_alternatives(words: tuple[str, ...]) -> str:
    """Return words as alternatives of a pattern: a longer one is tried first."""
    longest_first = sorted(words, key=len, reverse=True)
    spelt = (re.escape(unicodedata.normalize("NFC", word)) for word in longest_first)
    return "|".join(spelt).replace("/", "/ ?")
