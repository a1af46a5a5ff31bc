"""Figures drawn from the numbers of a question: symbols and digits only, words stay in the text.

In: the module of a figure and a number for each of its parameters. Out: one ``<svg>`` element and
the same picture in words. Must never know: templates, questions, papers, which figures there are.

A bank brings the modules; each draws one figure and offers what ``_module.FigureModule`` says. They
draw with ``kit``, pictures with ``photographs`` besides. Nothing here loads NumPy before the first
figure is drawn, and matplotlib draws none: its fonts were packed once.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import ModuleType
from typing import TYPE_CHECKING

from quizgen.errors import BankError
from quizgen.figures._board import Board, Drawing, Line
from quizgen.figures._figure import Figure
from quizgen.figures._module import FigureModule, checked, name_of
from quizgen.figures._parameters import Parameter, complete
from quizgen.figures._words import forget_words
from quizgen.locale import languages, numbers_in
from quizgen.maths.notation import people

if TYPE_CHECKING:
    from quizgen.figures._canvas import Canvas


def parameters(figure: ModuleType) -> Mapping[str, Parameter]:
    """Parameters of a figure: name to unit, meaning and default.

    Raises
    ------
    BankError
        If the module is no figure.
    """
    return checked(figure).PARAMETERS


def render(figure: ModuleType, values: Mapping[str, float], *, quiz: bool, lang: str) -> Figure:
    """Draw a figure, or take it from the cache.

    Parameters
    ----------
    figure : module
        What draws it, as ``Bank.figure(name)`` gives it.
    values : mapping of str to float
        Parameters in the units that ``parameters(figure)`` names. Optional ones may be left out.
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
        If the module is no figure, a parameter or the language is unknown, or a value cannot be
        drawn.
    """
    if lang not in languages():
        known = ", ".join(languages())
        name = name_of(figure)
        raise BankError(f"figure {name!r}: no alt text in {lang!r}, only in {known}")
    return _render(checked(figure), tuple(completed(figure, values).items()), quiz, lang)


def in_words(figure: ModuleType, values: Mapping[str, float], *, quiz: bool, lang: str) -> str:
    """What a figure shows, in words, without drawing it; parameters and errors as of ``render``."""
    return _told(checked(figure), completed(figure, values), lang, quiz=quiz)


def completed(figure: ModuleType, values: Mapping[str, float]) -> dict[str, float]:
    """All parameters of a figure, those left out at their defaults; errors as of ``render``."""
    return complete(name_of(figure), parameters(figure), values)


def _told(module: FigureModule, values: Mapping[str, float], lang: str, *, quiz: bool) -> str:
    return numbers_in(lang, people.names_in(module.alt(values, lang, quiz=quiz)))


@lru_cache(maxsize=256)
def _render(
    module: FigureModule, items: tuple[tuple[str, float], ...], quiz: bool, lang: str
) -> Figure:
    words = _told(module, dict(items), lang, quiz=quiz)
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
    "forget_words",
    "in_words",
    "parameters",
    "render",
]
