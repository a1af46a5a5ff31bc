"""Figures drawn from the numbers of a question: symbols and digits only, words stay in the text.

In: the name of a figure and a number for each of its parameters. Out: one ``<svg>`` element and
the same picture in words. Must never know: templates, questions, papers.

Each module draws one figure and offers what ``_table.FigureModule`` says. Nothing here loads NumPy
or matplotlib before the first figure is drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING

from quizgen.errors import BankError
from quizgen.figures._board import Board, Drawing, Line
from quizgen.figures._figure import Figure
from quizgen.figures._parameters import Parameter, complete
from quizgen.locale import languages
from quizgen.maths.notation import people

if TYPE_CHECKING:
    from quizgen.figures._canvas import Canvas

PHOTOGRAPHS = frozenset(
    {"artefacts", "depth_of_field", "fall_off", "focus_photos", "grey_edits", "noise"}
)
"""Figures that are pictures of the camera."""


def parameters(name: str) -> Mapping[str, Parameter]:
    """Parameters of a figure: name to unit, meaning and default.

    Raises
    ------
    BankError
        If there is no such figure.
    """
    from quizgen.figures._table import figure_module

    return figure_module(name).PARAMETERS


def render(name: str, values: Mapping[str, float], *, quiz: bool, lang: str) -> Figure:
    """Draw a figure, or take it from the cache.

    Parameters
    ----------
    name : str
        A key of ``_table.FIGURES``.
    values : mapping of str to float
        Parameters in the units that ``parameters(name)`` names. Optional ones may be left out.
    quiz : bool
        Hide what the question asks for.
    lang : str
        Language of the alt text; the drawing itself has no words.

    Returns
    -------
    Figure
        The same bytes for the same arguments, in every process.

    Raises
    ------
    BankError
        If the figure, a parameter or the language is unknown, or a value cannot be drawn.
    """
    if lang not in languages():
        known = ", ".join(languages())
        raise BankError(f"figure {name!r}: no alt text in {lang!r}, only in {known}")
    full = complete(name, parameters(name), values)
    return _render(name, tuple(full.items()), quiz, lang)


def in_words(name: str, values: Mapping[str, float], *, quiz: bool, lang: str) -> str:
    """What a figure shows, in words, without drawing it; parameters and errors as of ``render``."""
    from quizgen.figures._table import figure_module

    full = complete(name, parameters(name), values)
    return people.names_in(figure_module(name).alt(full, lang, quiz=quiz))


@lru_cache(maxsize=256)
def _render(name: str, items: tuple[tuple[str, float], ...], quiz: bool, lang: str) -> Figure:
    from quizgen.figures._table import figure_module

    words = in_words(name, dict(items), quiz=quiz, lang=lang)
    return Figure(_drawn(name, items, quiz), words, lang, figure_module(name).DARK)


@lru_cache(maxsize=256)
def _drawn(name: str, items: tuple[tuple[str, float], ...], quiz: bool) -> Canvas:
    from quizgen.figures._canvas import Canvas
    from quizgen.figures._table import figure_module

    canvas = Canvas()
    figure_module(name).draw(canvas, dict(items), quiz=quiz)
    return canvas


__all__ = ["Board", "Drawing", "Figure", "Line", "Parameter", "in_words", "parameters", "render"]
