"""Sentences of the checker in the learner's language, looked up by the language-free note."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from quizgen.marking.echo import safe

LANGUAGES = ("en", "bn")


@cache
def _tables(lang: str) -> dict[str, dict[str, str]]:
    lang = lang if lang in LANGUAGES else "en"
    text = (files("quizgen") / "locale" / f"check.{lang}.toml").read_text("utf-8")
    return tomllib.loads(text)


def sentences(lang: str) -> dict[str, str]:
    """Return the sentences of the notes; an unknown language falls back to English."""
    return _tables(lang)["notes"]


def words(lang: str) -> dict[str, str]:
    """Return the names of token kinds and short words used inside sentences."""
    return _tables(lang)["words"]


def practice_words(lang: str) -> dict[str, str]:
    """Return the sentences of ``quizgen practice``."""
    return _tables(lang)["practice"]


def say(lang: str, note: str, fields: Mapping[str, Any]) -> str:
    """Return the sentence for a note.

    Parameters
    ----------
    lang : str
        ``en`` or ``bn``.
    note : str
        Key of the sentence; an empty or unknown note has no sentence.
    fields : mapping
        Texts and numbers to fill in; learner's text among them is escaped and shortened.
    """
    sentence = sentences(lang).get(note, "")
    if not fields or "{" not in sentence:
        return sentence
    return sentence.format_map(_Blanks({key: _shown(lang, v) for key, v in fields.items()}))


class _Blanks(dict[str, str]):
    """A sentence never fails for want of a detail."""

    def __missing__(self, key: str) -> str:
        del key
        return "…"


def _shown(lang: str, value: Any) -> str:
    if isinstance(value, (tuple, list)):
        table = words(lang)
        return ", ".join(dict.fromkeys(safe(table.get(str(item), str(item))) for item in value))
    return safe(str(value), 120)
