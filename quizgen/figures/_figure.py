"""What every figure becomes."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from quizgen.figures._svg import with_title

if TYPE_CHECKING:
    from quizgen.figures._canvas import Canvas


@dataclass(frozen=True, eq=False)
class Figure:
    """A finished figure, written when it is asked for.

    Attributes
    ----------
    canvas : Canvas
        What was drawn.
    alt : str
        The same picture in words.
    lang : str
        The language of these words.
    dark : str
        ``"invert"`` (a dark page inverts the picture) or ``"keep"``.
    """

    canvas: Canvas = field(repr=False)
    alt: str
    lang: str
    dark: str

    @property
    def width_pt(self) -> float:
        """Natural width in points (1/72 inch)."""
        return round(self.canvas.width, 2)

    @property
    def height_pt(self) -> float:
        """Natural height in points."""
        return round(self.canvas.height, 2)

    @cached_property
    def svg(self) -> bytes:
        """One ``<svg>`` element in UTF-8, ready to stand inside an HTML page.

        No prolog, no ids, no style sheet, ``role="img"`` and the alt text as its ``<title>``; the
        same bytes on every machine.
        """
        return with_title(self.canvas.inside, self.width_pt, self.height_pt, self.alt, self.lang)

    @cached_property
    def light(self) -> bytes:
        """The same in few bytes and without its words, for a file that an ``<img>`` shows."""
        from quizgen.figures._light import light

        return light(self.canvas)

    def __eq__(self, other: object) -> bool:
        """Whether they show the same and say the same of it."""
        return isinstance(other, Figure) and self.svg == other.svg

    def __hash__(self) -> int:
        return hash(self.alt)

    def __repr__(self) -> str:
        return f"<Figure {self.width_pt:g} x {self.height_pt:g} pt, {len(self.svg)} bytes of SVG>"

    def _repr_html_(self) -> str:
        """The figure as a notebook shows it."""
        return self.svg.decode()
