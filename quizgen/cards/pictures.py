"""The figures on cards: those of the questions, and a few that only cards use."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from quizgen import figures
from quizgen.cards import drawings
from quizgen.figures import Figure


def draw(name: str, values: Mapping[str, Any], *, quiz: bool, lang: str) -> Figure:
    """Draw a figure.

    Parameters
    ----------
    name : str
        A figure of ``quizgen.figures`` or of ``quizgen.cards.drawings``.
    values : mapping
        Its parameters.
    quiz : bool
        Hide what is asked.
    lang : str
        Language of the alt text.

    Raises
    ------
    BankError
        If the figure or a parameter is unknown.
    """
    if name in drawings.DRAWINGS:
        return drawings.draw(name, quiz=quiz, lang=lang)
    return figures.render(name, values, quiz=quiz, lang=lang)
