"""What a figure's module offers.

The modules stand in banks. None loads NumPy before it draws.
"""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Protocol, cast

from quizgen.errors import BankError

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


def name_of(module: ModuleType) -> str:
    """What templates call a figure."""
    return module.__name__.rpartition(".")[2]


def checked(module: ModuleType) -> FigureModule:
    """A module that draws a figure.

    Raises
    ------
    BankError
        If it lacks something that a figure has.
    """
    for wanted in ("PARAMETERS", "DARK", "draw", "alt"):
        if not hasattr(module, wanted):
            what = f"figure {name_of(module)!r}: the module has no {wanted}"
            raise BankError(f"{what} (see docs/figures.md)")
    return cast("FigureModule", module)
