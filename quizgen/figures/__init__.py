"""Figures drawn from the numbers of a question: symbols and digits only, words stay in the text.

In: the name of a figure and a number for each of its parameters. Out: one ``<svg>`` element and
the same picture in words. Must never know: templates, questions, papers.

Each module draws one figure and offers what ``_table.FigureModule`` says. Nothing here loads NumPy
before the first figure is drawn, and matplotlib draws none: its fonts were packed once.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import ModuleType
from typing import TYPE_CHECKING

from quizgen.errors import BankError
from quizgen.figures._board import Board, Drawing, Line
from quizgen.figures._figure import Figure
from quizgen.figures._parameters import Parameter, complete
from quizgen.locale import languages, numbers_in
from quizgen.maths.notation import people

if TYPE_CHECKING:
    from quizgen.figures._canvas import Canvas
    from quizgen.figures._table import FigureModule

PHOTOGRAPHS = frozenset(
    {"artefacts", "depth_of_field", "fall_off", "focus_photos", "grey_edits", "noise"}
)
"""Figures that are pictures of the camera."""


def parameters(name: str, own: ModuleType | None = None) -> Mapping[str, Parameter]:
    """Parameters of a figure: name to unit, meaning and default.

    Raises
    ------
    BankError
        If there is no such figure.
    """
    return _module(name, own).PARAMETERS


def render(
    name: str,
    values: Mapping[str, float],
    *,
    quiz: bool,
    lang: str,
    own: ModuleType | None = None,
) -> Figure:
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
    own : module, optional
        What draws it, if it is a bank's own.

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
    full = completed(name, values, own)
    return _render(_module(name, own), tuple(full.items()), quiz, lang)


def in_words(
    name: str,
    values: Mapping[str, float],
    *,
    quiz: bool,
    lang: str,
    own: ModuleType | None = None,
) -> str:
    """What a figure shows, in words, without drawing it; parameters and errors as of ``render``."""
    return _words(_module(name, own), completed(name, values, own), lang, quiz=quiz)


def completed(
    name: str, values: Mapping[str, float], own: ModuleType | None = None
) -> dict[str, float]:
    """All parameters of a figure, those left out at their defaults; errors as of ``render``."""
    return complete(name, parameters(name, own), values)


def _module(name: str, own: ModuleType | None) -> FigureModule:
    from quizgen.figures._table import checked, figure_module

    return checked(name, own) if own else figure_module(name)


def _words(module: FigureModule, values: Mapping[str, float], lang: str, *, quiz: bool) -> str:
    return numbers_in(lang, people.names_in(module.alt(values, lang, quiz=quiz)))


@lru_cache(maxsize=256)
def _render(
    module: FigureModule, items: tuple[tuple[str, float], ...], quiz: bool, lang: str
) -> Figure:
    words = _words(module, dict(items), lang, quiz=quiz)
    return Figure(_drawn(module, items, quiz).written_in(lang), words, lang, module.DARK)


@lru_cache(maxsize=256)
def _drawn(module: FigureModule, items: tuple[tuple[str, float], ...], quiz: bool) -> Canvas:
    from quizgen.figures._canvas import Canvas

    canvas = Canvas()
    module.draw(canvas, dict(items), quiz=quiz)
    return canvas


__all__ = [
    "Board",
    "Drawing",
    "Figure",
    "Line",
    "Parameter",
    "completed",
    "in_words",
    "parameters",
    "render",
]
