"""A drawing as text: points ``x,y`` with blanks between, lines with ``;`` between."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from quizgen.marking.reading.rewrites import LONGEST_PROSE, normalise
from quizgen.marking.reading.source import Source
from quizgen.maths.notation import ReadError

Point = tuple[float, float]
Stroke = Sequence[Point]
"""A line that was drawn, from point to point."""
View = tuple[float, float, float, float]
"""What a field shows: from and to along x, from and to along y."""

BEYOND = 0.1
"""Share of the field by which a point may lie outside of it."""

_NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:e-?\d{1,2})?)"
_POINT = re.compile(rf"[(\[]? ?{_NUMBER} ?[,|] ?{_NUMBER} ?[)\]]?(?=[ ,(\[]|$)", re.IGNORECASE)
_NAME = re.compile(r"[^\d:=,.+-]*[:=]")
_BETWEEN = re.compile(r"[ ,]*")


def read_strokes(typed: str, view: View) -> list[list[Point]]:
    """Read the lines of a drawing; a lone point is no line.

    Raises
    ------
    ReadError
        If there is something else, a point far outside of the field, or no line at all.
    """
    source = normalise(re.sub(r"[\r\n]+", ";", typed), keep_x=True, longest=LONGEST_PROSE)
    lines, start = [], 0
    for end in (*(m.start() for m in re.finditer(";", source.text)), len(source.text)):
        placed = _points(source.cut(start, end).strip())
        lines.append([_inside(point, view, column) for point, column in placed])
        start = end + 1
    found = [line for line in lines if len({*line}) > 1]
    if not found:
        raise ReadError("two-points", 1)
    return found


def read_line(written: str) -> list[Point]:
    """The points of a line of a key.

    Raises
    ------
    ReadError
        If there is something else.
    """
    return [point for point, _ in _points(Source.of(written))]


def _points(source: Source) -> Iterator[tuple[Point, int]]:
    """Points and the columns that they stand at."""
    name = _NAME.match(source.text)
    at = name.end() if name else 0
    while (at := _after(_BETWEEN, source.text, at)) < len(source.text):
        match = _POINT.match(source.text, at)
        if match is None:
            raise ReadError("points-expected", source.column(at), source.text[at : at + 20])
        yield (float(match[1]), float(match[2])), source.column(at)
        at = match.end()


def _after(pattern: re.Pattern[str], text: str, at: int) -> int:
    match = pattern.match(text, at)
    return match.end() if match else at


def _inside(point: Point, view: View, column: int) -> Point:
    left, right, low, high = view
    wide, tall = BEYOND * (right - left), BEYOND * (high - low)
    (x, y) = point
    if left - wide <= x <= right + wide and low - tall <= y <= high + tall:
        return point
    limits = f"x {left:g} ... {right:g}, y {low:g} ... {high:g}"
    raise ReadError("outside-field", column, f"({x:g}; {y:g})", limits)


def written(lines: Iterable[Stroke], digits: tuple[int, int]) -> str:
    """Lines as they are typed, with so many decimals along x and along y."""
    along, up = digits
    return "; ".join(" ".join(f"{_short(x, along)},{_short(y, up)}" for x, y in line)
                     for line in lines)  # fmt: skip


def _short(value: float, digits: int) -> str:
    return f"{round(value, digits) + 0.0:g}"
