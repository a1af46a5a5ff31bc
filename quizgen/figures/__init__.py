"""Figures drawn from the numbers of a question: symbols and digits only, words stay in the text.

Each module draws one figure and has four names:

* ``PARAMETERS``: parameter name to unit, meaning and default
* ``draw(figure, values, *, quiz)``: draws on an empty matplotlib ``Figure``
* ``alt(values, lang, *, quiz)``: the same picture in words
* ``DARK``: ``"invert"`` for line art on nothing, ``"keep"`` for pictures on white

``values`` maps every parameter to a float in its unit. ``quiz`` hides what a question asks for;
the docstrings of ``draw`` and ``alt`` say what that is. Values that cannot be drawn raise
``BankError``.

Nothing here loads NumPy or matplotlib before the first figure is drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from typing import Any

from quizgen.errors import BankError
from quizgen.figures._parameters import Parameter, complete
from quizgen.locale import languages

FIGURES: Mapping[str, str] = {
    "artefacts": "quizgen.figures.artefacts",
    "bayer": "quizgen.figures.bayer",
    "blur_disc": "quizgen.figures.blur_disc",
    "depth_of_field": "quizgen.figures.depth_of_field",
    "distorted_grid": "quizgen.figures.distorted_grid",
    "gaussian": "quizgen.figures.gaussian",
    "hsv_edits": "quizgen.figures.hsv_edits",
    "luminosity": "quizgen.figures.luminosity",
    "noise": "quizgen.figures.noise",
    "normalisation": "quizgen.figures.normalisation",
    "pinhole": "quizgen.figures.pinhole",
    "thin_lens": "quizgen.figures.thin_lens",
}
"""Figure name to the module that draws it, imported when first used."""


@dataclass(frozen=True, slots=True)
class Figure:
    """A finished figure.

    Attributes
    ----------
    svg : bytes
        One ``<svg>`` element in UTF-8, ready to stand inside an HTML page: no prolog, no ids,
        no style sheet, ``role="img"`` and the alt text as its ``<title>``.
    alt : str
        The same picture in words.
    width_pt, height_pt : float
        Natural size in points (1/72 inch).
    dark : str
        ``"invert"`` (a dark page inverts the picture) or ``"keep"``.
    """

    svg: bytes
    alt: str
    width_pt: float
    height_pt: float
    dark: str


def parameters(name: str) -> Mapping[str, Parameter]:
    """Parameters of a figure: name to unit, meaning and default.

    Raises
    ------
    BankError
        If there is no such figure.
    """
    table: Mapping[str, Parameter] = _module(name).PARAMETERS
    return table


def render(name: str, values: Mapping[str, float], *, quiz: bool, lang: str) -> Figure:
    """Draw a figure, or take it from the cache.

    Parameters
    ----------
    name : str
        A key of ``FIGURES``.
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


@lru_cache(maxsize=256)
def _render(name: str, items: tuple[tuple[str, float], ...], quiz: bool, lang: str) -> Figure:
    from quizgen.figures._svg import with_title

    module = _module(name)
    body, width, height = _body(name, items, quiz)
    words = module.alt(dict(items), lang, quiz=quiz)
    return Figure(with_title(body, width, height, words, lang), words, width, height, module.DARK)


@lru_cache(maxsize=256)
def _body(name: str, items: tuple[tuple[str, float], ...], quiz: bool) -> tuple[str, float, float]:
    from quizgen.figures._svg import body

    module = _module(name)
    return body(lambda figure: module.draw(figure, dict(items), quiz=quiz))


def _module(name: str) -> Any:
    if name not in FIGURES:
        raise BankError(f"unknown figure {name!r}; there are {', '.join(FIGURES)}")
    return import_module(FIGURES[name])


__all__ = ["FIGURES", "Figure", "Parameter", "parameters", "render"]
