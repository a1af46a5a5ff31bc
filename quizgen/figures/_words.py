"""Figures in words: ``figures.toml`` of a language."""

from __future__ import annotations

from quizgen.locale import table


def words_of(figure: str, lang: str) -> dict[str, str]:
    """Sentences of a figure's alternative text."""
    sentences: dict[str, str] = table(lang, "figures")[figure]
    return sentences
