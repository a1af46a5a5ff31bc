"""What a figure's module offers, and what every figure becomes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from inspect import signature
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Protocol, cast

from quizgen.core.errors import BankError

if TYPE_CHECKING:
    from quizgen.figures.parameters import Parameter, Values
    from quizgen.figures.svg import Label


class FigureModule(Protocol):
    """A module that draws one figure: its parameters, the drawing, and a description in words.

    It may also have ``SIZE``, width and height in points of its axes or sheet (``COLUMN``,
    ``WIDE`` and ``SQUARE`` of the kit are ready ones); ``COLOUR = True``, or a function of the
    values, if it cannot be read on grey paper; and ``mark(place, values, marks)``, which draws
    values of a learner next to the right ones, with ``MARKS``, the quantities that it knows.
    """

    PARAMETERS: dict[str, Parameter]
    """Parameter name to unit, meaning, range and default."""

    def __hash__(self) -> int:
        """Return a hash: drawn figures are cached by their module."""
        ...

    def draw(self, place: Any, values: Values, *, quiz: bool) -> None:
        """Draw with matplotlib.

        The first parameter is called ``ax`` (axes of the house) or ``fig`` (a figure of
        matplotlib whose unit is the point); ``quiz`` hides what the question asks for. Symbols and
        digits only: with a parameter ``lang`` it may write words, too.
        """
        ...

    def alt(self, values: Values, lang: str, *, quiz: bool) -> str:
        """Return the figure's description in words, in a language of the bank."""
        ...


def figure_name(module: ModuleType) -> str:
    """Return the name by which templates refer to a figure."""
    return module.__name__.rpartition(".")[2]


def _find_module_file(module: ModuleType) -> Path | None:
    """Return the file of a module, None if it has none."""
    found = getattr(module, "__file__", None)
    return Path(found) if found else None


def check_figure_module(module: ModuleType) -> FigureModule:
    """Return a module that was checked to draw a figure.

    Raises
    ------
    BankError
        If it lacks something that a figure has.
    """
    what = f"figure {figure_name(module)!r}: the module"
    for name in ("PARAMETERS", "draw", "alt"):
        if not hasattr(module, name):
            said = f"{what} has no {name} (see docs/figures.md)"
            raise BankError(said, rule="QG145", file=_find_module_file(module))
    if first_parameter(module.draw) not in {"ax", "fig"}:
        said = f"{what}'s draw() takes 'ax' or 'fig' first (see docs/figures.md)"
        raise BankError(said, rule="QG145", file=_find_module_file(module))
    return cast("FigureModule", module)


@lru_cache(256)
def parameters_of(function: Any) -> tuple[str, ...]:
    """Return the names of a function's parameters, cached, as inspection is slow."""
    return tuple(signature(function).parameters)


def first_parameter(function: Any) -> str:
    """Return the name of a function's first parameter."""
    return next(iter(parameters_of(function)), "")


def needs_colour(module: ModuleType | FigureModule, values: Mapping[str, Any]) -> bool:
    """Return whether a figure with these values cannot be read in greyscale."""
    rule = getattr(module, "COLOUR", False)
    return bool(rule(values) if callable(rule) else rule)


_WORDS = re.compile(rb"<title>.*?</title>(<desc>.*?</desc>)?", re.DOTALL)
_LANGUAGE = re.compile(rb' lang="[A-Za-z0-9-]+"')
_VARIABLE = re.compile(rb"var\(--fig-[a-z-]+,(#[0-9a-f]{6})\)")


@dataclass(frozen=True, eq=False)
class Figure:
    """A finished figure: SVG, size, description and labels.

    Attributes
    ----------
    inline_svg : bytes
        One ``<svg>`` in UTF-8 for an HTML page: no prolog, no style sheet, ``role="img"``, title
        and description; the same bytes on every machine. Its inks are CSS variables
        (``--fig-blue``), black is ``currentColor``, so that a page decides on light and dark.
    width_pt, height_pt : float
        Natural size in points (1/72 inch).
    origin_pt : tuple of float
        Where the view box begins, from the upper left corner of the sheet.
    alt : str
        The same picture in words.
    lang : str
        The language of these words.
    labels : tuple of Label
        Texts in the picture with their boxes, in the order of drawing.
    needs_colour : bool
        Whether it cannot be read on grey paper.
    outside : int
        Markers that fall outside their axes, and are not drawn.
    unnamed_axes : int
        Axes that have numbers, and nothing that says of what.
    """

    inline_svg: bytes = field(repr=False)
    width_pt: float
    height_pt: float
    alt: str = field(repr=False)
    lang: str
    origin_pt: tuple[float, float] = (0.0, 0.0)
    labels: tuple[Label, ...] = field(default=(), repr=False)
    needs_colour: bool = False
    outside: int = 0
    unnamed_axes: int = 0

    @cached_property
    def standalone_svg(self) -> bytes:
        """The SVG file in fixed colours on light paper, for programs without a page's variables.

        Without its description, so that all languages share one file.
        """
        bare = _WORDS.sub(b"", _LANGUAGE.sub(b"", self.inline_svg, count=1), count=1)
        return _VARIABLE.sub(rb"\1", bare).replace(b"currentColor", b"#000000")

    def __eq__(self, other: object) -> bool:
        """Return whether two figures have the same SVG, description included."""
        return isinstance(other, Figure) and self.inline_svg == other.inline_svg

    def __hash__(self) -> int:
        """Return a hash of the SVG."""
        return hash(self.inline_svg)

    def _repr_html_(self) -> str:
        """Return the SVG for a notebook."""
        return self.inline_svg.decode()
