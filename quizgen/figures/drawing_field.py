"""A field with axes that a learner draws in: empty, or with the lines that were wanted."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from math import ceil, floor
from typing import TYPE_CHECKING, Any

import msgspec

from quizgen.figures.alt_text import format_given, strip_mathtext
from quizgen.figures.contract import Figure
from quizgen.figures.loading import load_engine
from quizgen.kinds.contract import FOOT, LEFT, NAME, DrawingField, Line, Point
from quizgen.locale import get_language, load_words, localise_numbers
from quizgen.maths.notation.pretty import format_name

if TYPE_CHECKING:
    from quizgen.figures.sketch import Sketch


class FieldPicture(msgspec.Struct, frozen=True):
    """A field to draw in, and the lines in it, described in a language."""

    field: DrawingField
    lang: str
    lines: tuple[Line, ...] = ()

    @property
    def figure(self) -> Figure:
        """The drawn field."""
        return _draw_field(self)

    @property
    def alt(self) -> str:
        """The description of the field in words, without drawing it."""
        words, field = load_words(self.lang, "figures")["field"], self.field
        text = words["solved" if self.lines else "empty"]
        text += words["ranges"].format(
            *map(format_given, field.view), *map(format_given, field.grid)
        )
        for key, axis in zip(("across", "upright"), field.axes, strict=True):
            text += words[key].format(strip_mathtext(axis)) if axis else ""
        if field.given:
            text += words["given"].format(_format_lines(field.given))
        if field.marks:
            marks = "; ".join(
                f"{format_name(label)} {_format_point(point)}" for label, point in field.marks
            )
            text += words["marks"].format(marks)
        text += words["wanted"].format(_format_lines(self.lines)) if self.lines else ""
        return localise_numbers(self.lang, text)


@lru_cache(maxsize=256)
def _draw_field(picture: FieldPicture) -> Figure:
    """Return the drawn field, cached."""
    load_engine()
    from quizgen.figures.engine import draw_sheet
    from quizgen.figures.svg import write_svg

    field, decimal = picture.field, get_language(picture.lang).decimal

    def draw(sheet: Any) -> None:
        """Draw axes, given lines and the learner's or the right lines."""
        sketch = sheet.sketch()
        _draw_axes(sketch, field)
        for line in field.given:
            points = [field.to_picture(point) for point in line]
            if field.bars:
                sketch.line(points, "rule", 7.0, part="given")
            else:
                sketch.line(points, "grey", 1.2, dashes=(5.0, 2.0), part="given")
        for line in picture.lines:
            points = [field.to_picture(point) for point in line]
            sketch.line(points, "blue", 1.8, part="wanted")
        for label, point in field.marks:
            x, y = field.to_picture(point)
            sketch.dot((x, y), 2.2, "red", part="marks")
            sketch.label((x + 4, y + 8), f"${label}$", "l", fill="red", part="marks")

    drawing = draw_sheet(draw, field.picture_size, decimal, axes=False, fixed=True)
    return Figure(
        write_svg(drawing, picture.alt, picture.lang), drawing.width, drawing.height,
        picture.alt, picture.lang, labels=drawing.labels,
    )  # fmt: skip


def _draw_axes(sketch: Sketch, field: DrawingField) -> None:
    """Draw grid, axes and their numbers."""
    left, right, low, high = field.view
    size = 8.0
    for x in _iter_ticks(left, right, field.grid[0]):
        foot, top = field.to_picture((x, low)), field.to_picture((x, high))
        sketch.line([foot, top], "rule" if x else "grey", 0.4 if x else 0.7, part="grid")
        sketch.label((foot[0], foot[1] - 8), format_given(x), "c", size)
    for y in _iter_ticks(low, high, field.grid[1]):
        start, end = field.to_picture((left, y)), field.to_picture((right, y))
        sketch.line([start, end], "rule" if y else "grey", 0.4 if y else 0.7, part="grid")
        sketch.label((start[0] - 4, start[1]), format_given(y), "r", size)
    corners = [(left, low), (right, low), (right, high), (left, high)]
    places = [field.to_picture(corner) for corner in corners]
    sketch.area(places, None, "ink", 0.7, part="frame")
    across, upright = field.axes
    if across:
        x, y = places[1]
        sketch.label((x, y - FOOT - NAME / 2 + 3), across, "r", 9.5, part="names")
    if upright:
        x, y = places[3]
        sketch.label((x - LEFT + 2, y + NAME / 2 + 3), upright, "l", 9.5, part="names")


def _iter_ticks(first: float, last: float, step: float) -> Iterator[float]:
    """Yield the multiples of a step from first to last."""
    slack = 1e-9 * (last - first)
    for count in range(ceil((first - slack) / step), floor((last + slack) / step) + 1):
        yield round(count * step, 9) + 0.0


def _format_lines(lines: tuple[Line, ...]) -> str:
    """Return lines as text: their points, lines parted by semicolons."""
    return "; ".join(", ".join(map(_format_point, line)) for line in lines)


def _format_point(point: Point) -> str:
    """Return a point as ``(x; y)``, rounded to 3 decimals."""
    return "({}; {})".format(*(format_given(round(value, 3)) for value in point))
