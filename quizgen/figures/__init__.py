"""Figures drawn by matplotlib from the values of a question: symbols and digits, words beside them.

In: the module of a figure and a value for each of its parameters. Out: one ``<svg>`` element and
the same picture in words. Must never know: templates, questions, papers, which figures there are.

A bank brings the modules; each draws one figure and offers what ``contract.FigureModule`` says.
matplotlib is loaded when the first figure is drawn, and never pyplot.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from types import ModuleType
from typing import TYPE_CHECKING, Any

from quizgen.core.errors import BankError
from quizgen.figures.alt_text import clear_alt_words
from quizgen.figures.contract import (
    Figure,
    FigureModule,
    check_figure_module,
    figure_name,
    needs_colour,
)
from quizgen.figures.drawing_field import FieldPicture
from quizgen.figures.loading import load_engine
from quizgen.figures.parameters import Parameter, fill_defaults
from quizgen.locale import get_language, list_languages, localise_numbers
from quizgen.maths.notation import pretty

if TYPE_CHECKING:
    from quizgen.figures.engine import Items
    from quizgen.figures.svg import Drawing


def figure_parameters(figure: ModuleType) -> Mapping[str, Parameter]:
    """Return the parameters of a figure by name: unit, meaning and default of each.

    Raises
    ------
    BankError
        If the module is no figure.
    """
    return check_figure_module(figure).PARAMETERS


def draw_figure(
    figure: ModuleType, values: Mapping[str, Any], *, quiz: bool, lang: str,
    marks: Mapping[str, float] | None = None,
) -> Figure:  # fmt: skip
    """Return a drawn figure, from the cache if it was drawn before.

    Parameters
    ----------
    figure : module
        What draws it, as ``Bank.figure(name)`` gives it.
    values : mapping of str to number, list, table or text
        Parameters in the units that ``figure_parameters(figure)`` names. Optional ones may be left
        out.
    quiz : bool
        Hide what the question asks for.
    lang : str
        Language of the description, and of the decimal signs in the picture.
    marks : mapping of str to float, optional
        Values of a learner, to be drawn next to the right ones by the figure's ``mark``.

    Returns
    -------
    Figure
        The same bytes for the same arguments, in every process and on every machine.

    Raises
    ------
    BankError
        If the module is no figure, a parameter or the language is unknown, or a value cannot be
        drawn.
    """
    if lang not in list_languages():
        known = ", ".join(list_languages())
        name = figure_name(figure)
        raise BankError(f"figure {name!r}: no alt text in {lang!r}, only in {known}")
    module = check_figure_module(figure)
    if marks and not hasattr(module, "mark"):
        raise BankError(f"figure {figure_name(figure)!r} has no mark(): it shows no other values")
    items = tuple(complete_parameters(figure, values).items())
    return _draw_items(module, items, quiz, lang, tuple((marks or {}).items()))


def describe_figure(figure: ModuleType, values: Mapping[str, Any], *, quiz: bool, lang: str) -> str:
    """Return a figure's description in words, without drawing it.

    Arguments as for ``draw_figure``.
    """
    values = complete_parameters(figure, values)
    return _describe_values(check_figure_module(figure), values, lang, quiz=quiz)


def complete_parameters(figure: ModuleType, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return all parameters of a figure, those left out at their defaults."""
    return fill_defaults(figure_name(figure), figure_parameters(figure), values)


def plot_figure(
    draw: Callable[[Any], object], alt: str, lang: str,
    size: tuple[float, float] | None = None,
) -> Figure:  # fmt: skip
    """Return a plot that belongs to no question: of a class, of progress, of measurements.

    Parameters
    ----------
    draw : callable
        Draws on axes of the house.
    alt : str
        The plot in words.
    lang : str
        Language of these words; numbers take its decimal sign.
    size : tuple of float, optional
        Width and height of the axes in points; a text column by default.
    """
    load_engine()
    from quizgen.figures.engine import draw_sheet
    from quizgen.figures.kit import COLUMN

    drawing = draw_sheet(draw, size or COLUMN, get_language(lang).decimal, axes=True)
    return _finish_figure(drawing, alt, lang)


def _describe_values(
    module: FigureModule, values: Mapping[str, Any], lang: str, *, quiz: bool
) -> str:
    """Return a figure's description, with names and numbers as a language writes them."""
    return localise_numbers(lang, pretty.format_names_in(module.alt(values, lang, quiz=quiz)))


@lru_cache(maxsize=256)
def _draw_items(module: FigureModule, items: Items, quiz: bool, lang: str, marks: Items) -> Figure:
    """Return a drawn figure, cached by its values in hashable form."""
    load_engine()
    from quizgen.figures.engine import draw_module

    decimal, values = get_language(lang).decimal, dict(items)
    drawing = draw_module(module, items, quiz=quiz, lang=lang, decimal=decimal, marks=marks)
    alt = _describe_values(module, values, lang, quiz=quiz)
    return _finish_figure(drawing, alt, lang, colour=needs_colour(module, values))


def _finish_figure(drawing: Drawing, alt: str, lang: str, *, colour: bool = False) -> Figure:
    """Return a figure made of a drawing and its description."""
    from quizgen.figures.svg import write_svg

    return Figure(
        write_svg(drawing, alt, lang), drawing.width, drawing.height, alt, lang,
        drawing.origin, drawing.labels, colour, drawing.outside, drawing.unnamed_axes,
    )  # fmt: skip


__all__ = [
    "FieldPicture",
    "Figure",
    "Parameter",
    "clear_alt_words",
    "complete_parameters",
    "describe_figure",
    "draw_figure",
    "figure_parameters",
    "needs_colour",
    "plot_figure",
]
