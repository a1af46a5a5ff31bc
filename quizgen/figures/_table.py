"""Every figure by name, and what a figure's module offers.

The modules do not load NumPy before they draw.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType
from typing import TYPE_CHECKING, Protocol, cast

from quizgen.errors import BankError
from quizgen.figures import (
    artefacts,
    bayer,
    blur_curve,
    blur_disc,
    depth_of_field,
    distorted_grid,
    fall_off,
    focus_photos,
    gaussian,
    grey_edits,
    hsv_edits,
    luminosity,
    noise,
    normalisation,
    pinhole,
    staircase,
    thin_lens,
)

if TYPE_CHECKING:
    from quizgen.figures._canvas import Canvas
    from quizgen.figures._parameters import Parameter, Values


class FigureModule(Protocol):
    """One figure: what it is drawn from, the drawing, and the same picture in words.

    ``values`` maps every parameter to a float in its unit. ``quiz`` hides what a question asks
    for; the docstrings of ``draw`` and ``alt`` say what that is. Values that cannot be drawn raise
    ``BankError``.
    """

    PARAMETERS: dict[str, Parameter]
    """Parameter name to unit, meaning and default."""

    DARK: str
    """``"invert"`` for line art on nothing, ``"keep"`` for pictures on white."""

    def __hash__(self) -> int:
        """Modules are what drawn figures are kept by."""
        ...

    def draw(self, canvas: Canvas, values: Values, *, quiz: bool) -> None:
        """Draw on an empty ``Canvas``: symbols and digits only."""
        ...

    def alt(self, values: Values, lang: str, *, quiz: bool) -> str:
        """Describe the figure in words, in a language of the locale folder."""
        ...


FIGURES: Mapping[str, FigureModule] = {
    "artefacts": artefacts,
    "bayer": bayer,
    "blur_curve": blur_curve,
    "blur_disc": blur_disc,
    "depth_of_field": depth_of_field,
    "distorted_grid": distorted_grid,
    "fall_off": fall_off,
    "focus_photos": focus_photos,
    "gaussian": gaussian,
    "grey_edits": grey_edits,
    "hsv_edits": hsv_edits,
    "luminosity": luminosity,
    "noise": noise,
    "normalisation": normalisation,
    "pinhole": pinhole,
    "staircase": staircase,
    "thin_lens": thin_lens,
}


def checked(name: str, module: ModuleType) -> FigureModule:
    """A module that draws a figure of a bank's own.

    Raises
    ------
    BankError
        If it lacks something that a figure has.
    """
    for wanted in ("PARAMETERS", "DARK", "draw", "alt"):
        if not hasattr(module, wanted):
            raise BankError(f"figure {name!r}: the module has no {wanted} (see docs/figures.md)")
    return cast("FigureModule", module)


def figure_module(name: str) -> FigureModule:
    """The module that draws a figure.

    Raises
    ------
    BankError
        If there is no such figure.
    """
    if name not in FIGURES:
        raise BankError(f"unknown figure {name!r}; there are {', '.join(FIGURES)}")
    return FIGURES[name]
