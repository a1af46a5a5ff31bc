"""A pen that works in points; strokes of one part in one style become one compound path."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, pi, sin
from typing import TYPE_CHECKING

from quizgen.figures._canvas import CLOSE, MOVE, Canvas, Label, Style
from quizgen.figures._canvas import LINE as LINE_TO
from quizgen.figures._letters import width

if TYPE_CHECKING:
    import numpy as np

Point = tuple[float, float]
WIDTH, HEIGHT = 312.0, 170.0
"""Usual size of a figure in points: 11 cm by 6 cm."""

LABEL = 10.5
"""Size of labels in points."""

_HEAD, _HALF = 7.0, 2.4
_CIRCLE = [(cos(2 * pi * i / 24), sin(2 * pi * i / 24)) for i in range(24)]


_MOVE, _STRAIGHT, _CLOSE = (bytes([code]) for code in (MOVE, LINE_TO, CLOSE))

INK = Style()
SHADE = Style(colour="#d2d2d2")
DEEP = Style(colour="#aaaaaa")
LINE = Style(1.0)
BOLD = Style(1.8)
THIN = Style(0.7)
RAY = Style(1.1)
DASHED = Style(0.9, dashes=(4.0, 2.5))
DOTTED = Style(0.7, dashes=(1.2, 2.2))
GREY = Style(0.7, "#a0a0a0")
RED = Style(1.8, "#c00000")


class Pen:
    """Collects strokes, fills and labels of one figure.

    Parameters
    ----------
    width, height : float
        Size of the figure in points. The origin is at the lower left.
    """

    def __init__(self, width: float = WIDTH, height: float = HEIGHT) -> None:
        self.width = width
        self.height = height
        self.paths: dict[tuple[str, Style], tuple[list[Point], bytearray]] = {}
        self.labels: list[Label] = []

    def _add(
        self, part: str, style: Style, points: Sequence[Point] | np.ndarray, *, closed: bool
    ) -> None:
        path, codes = self.paths.setdefault((part, style), ([], bytearray()))
        row = points if isinstance(points, Sequence) else points.tolist()
        path += row
        codes += _MOVE + _STRAIGHT * (len(row) - 1)
        if closed:
            path.append(row[0])
            codes += _CLOSE

    def line(self, part: str, points: Sequence[Point] | np.ndarray, style: Style = LINE) -> None:
        """Draw a polyline."""
        self._add(part, style, points, closed=False)

    def area(self, part: str, points: Sequence[Point] | np.ndarray, style: Style = SHADE) -> None:
        """Fill a polygon, or outline it if the style is a line."""
        self._add(part, style, points, closed=True)

    def dot(self, part: str, at: Point, radius: float = 2.2, style: Style = INK) -> None:
        """Draw a disc."""
        self.area(part, [(at[0] + radius * x, at[1] + radius * y) for x, y in _CIRCLE], style)

    def head(self, part: str, tip: Point, way: Point, style: Style = INK) -> None:
        """Draw an arrow head with its tip at a point, pointing along ``way``."""
        length = hypot(*way)
        x, y = way[0] / length, way[1] / length
        base = (tip[0] - _HEAD * x, tip[1] - _HEAD * y)
        self.area(
            f"{part}-head",
            [
                tip,
                (base[0] - _HALF * y, base[1] + _HALF * x),
                (base[0] + _HALF * y, base[1] - _HALF * x),
            ],
            Style(colour=style.colour),
        )

    def arrow(self, part: str, start: Point, tip: Point, style: Style = LINE) -> None:
        """Draw a straight arrow; the shaft ends inside the head."""
        way = (tip[0] - start[0], tip[1] - start[1])
        cut = 1 - min(1.0, (_HEAD - 1) / hypot(*way))
        self.line(part, [start, (start[0] + cut * way[0], start[1] + cut * way[1])], style)
        self.head(part, tip, way, style)

    def ray(self, part: str, points: Sequence[Point], style: Style = RAY) -> None:
        """Draw light along a polyline, with an arrow head a little past the middle of the first."""
        self.line(part, points, style)
        (x1, y1), (x2, y2) = points[0], points[1]
        self.head(part, (x1 + 0.58 * (x2 - x1), y1 + 0.58 * (y2 - y1)), (x2 - x1, y2 - y1), style)

    def label(self, at: Point, text: str, anchor: str = "c", size: float = LABEL) -> None:
        """Write a label.

        Parameters
        ----------
        at : tuple of float
            Anchor in points.
        text : str
            Markup of ``quizgen.figures._letters``.
        anchor : {"c", "l", "r"}
            The anchor is the centre, the left or the right end; vertically it is the middle of
            the digits.
        size : float
            Size of the letters in points.
        """
        shift = {"c": 0.5, "l": 0.0, "r": 1.0}[anchor] * width(text) * size
        self.labels.append(Label(text, (at[0] - shift, at[1] - 0.33 * size), size))

    def dimension(self, start: Point, end: Point, text: str, beside: str = "") -> None:
        """Draw a level double arrow with its label in a gap.

        A short one has its label below, or beside it (``"l"`` to the left, ``"r"`` to the right).
        """
        (x1, y), (x2, _) = sorted([start, end])
        middle, half = (x1 + x2) / 2, text_width(text) / 2 + 3
        if x2 - x1 > 2 * half + 2 * _HEAD:
            self.arrow("dimensions", (middle - half, y), (x1, y), THIN)
            self.arrow("dimensions", (middle + half, y), (x2, y), THIN)
            self.label((middle, y), text)
        else:
            self._short(x1, x2, y)
            places = {"": (middle, y - 9.5), "l": (x1 - 4, y), "r": (x2 + 4, y)}
            self.label(places[beside], text, {"": "c", "l": "r", "r": "l"}[beside])

    def _short(self, x1: float, x2: float, y: float) -> None:
        if x2 - x1 > 2 * _HEAD:
            self.arrow("dimensions", ((x1 + x2) / 2, y), (x1, y), THIN)
            self.arrow("dimensions", ((x1 + x2) / 2, y), (x2, y), THIN)
        else:
            self.arrow("dimensions", (x1 - 14, y), (x1, y), THIN)
            self.arrow("dimensions", (x2 + 14, y), (x2, y), THIN)

    def break_mark(self, at: Point) -> None:
        """Draw two slanted strokes on an axis: distances along it are not to scale."""
        for shift in (-2.0, 2.0):
            x = at[0] + shift
            self.line("break", [(x - 2.5, at[1] - 5), (x + 2.5, at[1] + 5)], LINE)

    def onto(self, canvas: Canvas, background: str | None = None) -> None:
        """Size a canvas and put everything on it, in the order of drawing.

        Parameters
        ----------
        canvas : Canvas
            An empty canvas, or one with pictures.
        background : str, optional
            Colour of the paper; without it the figure is transparent.
        """
        canvas.size(self.width, self.height, background)
        for (part, style), (points, codes) in self.paths.items():
            canvas.path(part, style, points, bytes(codes))
        canvas.labels = self.labels


def text_width(text: str, size: float = LABEL) -> float:
    """Width of a label in points."""
    return width(text) * size
