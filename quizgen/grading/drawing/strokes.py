"""A drawing as text: points ``x,y`` with blanks between, lines with ``;`` between."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from quizgen.grading.reading.normalise import LONGEST_PROSE, normalise_typed
from quizgen.grading.reading.source_map import SourceText
from quizgen.maths.notation import FormulaReadError

FieldPoint = tuple[float, float]
StrokePoints = Sequence[FieldPoint]
"""A line that was drawn, from point to point."""
FieldBounds = tuple[float, float, float, float]
"""What a field shows: from and to along x, from and to along y."""

BEYOND = 0.1
"""Share of the field by which a point may lie outside of it."""

_NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:e-?\d{1,2})?)"
_POINT = re.compile(rf"[(\[]? ?{_NUMBER} ?[,|] ?{_NUMBER} ?[)\]]?(?=[ ,(\[]|$)", re.IGNORECASE)
_NAME = re.compile(r"[^\d:=,.+-]*[:=]")
_BETWEEN = re.compile(r"[ ,]*")


def read_strokes(typed: str, view: FieldBounds) -> list[list[FieldPoint]]:
    """Return the lines of a drawing; a lone point is no line.

    Raises
    ------
    FormulaReadError
        If there is something else, a point far outside of the field, or no line at all.
    """
    source = normalise_typed(re.sub(r"[\r\n]+", ";", typed), keep_x=True, longest=LONGEST_PROSE)
    lines, start = [], 0
    for end in (*(m.start() for m in re.finditer(";", source.text)), len(source.text)):
        placed = _iter_points(source.slice(start, end).strip())
        lines.append([_require_in_view(point, view, column) for point, column in placed])
        start = end + 1
    found = [line for line in lines if len({*line}) > 1]
    if not found:
        raise FormulaReadError("two-points", 1)
    return found


def parse_key_line(written: str) -> list[FieldPoint]:
    """Return the points of a line of a key.

    Raises
    ------
    FormulaReadError
        If there is something else.
    """
    return [point for point, _ in _iter_points(SourceText.of(written))]


def _iter_points(source: SourceText) -> Iterator[tuple[FieldPoint, int]]:
    """Yield points and the columns that they stand at.

    Raises
    ------
    FormulaReadError
        Where something else stands.
    """
    name = _NAME.match(source.text)
    at = name.end() if name else 0
    while (at := _skip_pattern(_BETWEEN, source.text, at)) < len(source.text):
        match = _POINT.match(source.text, at)
        if match is None:
            raise FormulaReadError("points-expected", source.column(at), source.text[at : at + 20])
        yield (float(match[1]), float(match[2])), source.column(at)
        at = match.end()


def _skip_pattern(pattern: re.Pattern[str], text: str, at: int) -> int:
    """Return the position behind a match that begins at ``at``, or ``at`` if there is none."""
    match = pattern.match(text, at)
    return match.end() if match else at


def _require_in_view(point: FieldPoint, view: FieldBounds, column: int) -> FieldPoint:
    """Return a point that lies in the field, or nearly.

    Raises
    ------
    FormulaReadError
        If it lies farther outside of the field than ``BEYOND``.
    """
    left, right, low, high = view
    wide, tall = BEYOND * (right - left), BEYOND * (high - low)
    (x, y) = point
    if left - wide <= x <= right + wide and low - tall <= y <= high + tall:
        return point
    limits = f"x {left:g} ... {right:g}, y {low:g} ... {high:g}"
    raise FormulaReadError("outside-field", column, f"({x:g}; {y:g})", limits)


def format_strokes(lines: Iterable[StrokePoints], digits: tuple[int, int]) -> str:
    """Return lines as they are typed, with so many decimals along x and along y."""
    along, up = digits
    return "; ".join(" ".join(f"{_format_short(x, along)},{_format_short(y, up)}" for x, y in line)
                     for line in lines)  # fmt: skip


def _format_short(value: float, digits: int) -> str:
    """Return a number with at most so many decimals; 0 has no minus sign."""
    return f"{round(value, digits) + 0.0:g}"
