"""Interface words of each language, from ``<lang>.toml`` in this folder."""

from __future__ import annotations

import tomllib
from fractions import Fraction
from functools import cache
from importlib.resources import files
from typing import Any

from quizgen.errors import QuizgenError


@cache
def table(lang: str) -> dict[str, Any]:
    """All words of a language.

    Raises
    ------
    QuizgenError
        If there is no such language.
    """
    path = files(__name__) / f"{lang}.toml"
    if not path.is_file():
        raise QuizgenError(f"no interface words for language {lang!r} (there are en, bn)")
    return tomllib.loads(path.read_text(encoding="utf-8"))


def word(lang: str, key: str, **values: object) -> str:
    """One word or sentence, ``section.name``, with its blanks filled in."""
    section, _, name = key.partition(".")
    text: str = table(lang)[section][name]
    return text.format(**values) if values else text


def marks(points: Fraction, lang: str) -> str:
    """Marks with their word: ``1 point``, ``2.5 points``."""
    return f"{float(points):g} {word(lang, 'paper.point' if points == 1 else 'paper.points')}"
