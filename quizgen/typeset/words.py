"""The words in and around formulas: ``speech.toml`` of a language, checked."""

from __future__ import annotations

from functools import cache

import msgspec

from quizgen.core.decoding import convert
from quizgen.core.errors import QuizgenError
from quizgen.locale import load_words


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
    short: dict[str, str]
    long: dict[str, str]
    prefixes: dict[str, str]
    units: dict[str, tuple[str, str]]
    unit_joints: dict[str, str]


@cache
def load_speech_words(lang: str) -> SpeechWords:
    """Read the words of a language, once.

    Raises
    ------
    QuizgenError
        If there is no such language, or a table is missing in its file.
    """
    try:
        return convert(load_words(lang, "speech"), SpeechWords)
    except msgspec.ValidationError as error:
        raise QuizgenError(f"{lang}/speech.toml: {error}") from error
