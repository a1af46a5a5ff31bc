"""A field with axes that a learner draws in: empty, or with the lines that were wanted."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from math import ceil, floor
from typing import TYPE_CHECKING

import msgspec

from quizgen.figures._figure import Figure
from quizgen.figures._numbers import given
from quizgen.locale import numbers_in, table
from quizgen.maths.notation.people import name

if TYPE_CHECKING:
    from quizgen.figures._pen import Pen

Point = tuple[float, float]
Line = tuple[Point, ...]

WIDE = 250.0
"""Width of the field in points: 88 mm."""
LEFT, RIGHT, TOP, FOOT = 26.0, 8.0, 8.0, 18.0
"""Room around the field, at the left and at the foot for numbers."""


class Board(msgspec.Struct, frozen=True):
    """A field to draw in.

    Parameters
    ----------
    view : tuple of float
        From and to along x, from and to along y.
    grid : tuple of float
        Distance of the grid's lines along x and along y.
    tall : float
        Height over width, where the axes do not have one scale.
    given : tuple of lines
        What is there already, in grey.
    marks : tuple of (str, point)
        Points with a label.
    """

    view: tuple[float, float, float, float]
    grid: tuple[float, float]
    tall: float = 0.0
    given: tuple[Line, ...] = ()
    marks: tuple[tuple[str, Point], ...] = ()

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the field itself in points."""
        left, right, low, high = self.view
        return WIDE, WIDE * (self.tall or (high - low) / (right - left))

    @property
    def picture(self) -> Point:
        """Width and height of the picture in points: the field and the room around it."""
        wide, tall = self.size
        return LEFT + wide + RIGHT, TOP + tall + FOOT

    @property
    def frame(self) -> tuple[float, float, float, float]:
        """Where the field lies in the picture, in points from the upper left: x, y, size."""
        return (LEFT, TOP, *self.size)

    def place(self, point: Point) -> Point:
        """A point in the picture, from the lower left."""
        left, right, low, high = self.view
        wide, tall = self.size
        x, y = point
        return LEFT + (x - left) / (right - left) * wide, FOOT + (y - low) / (high - low) * tall


class Drawing(msgspec.Struct, frozen=True):
    """A field to draw in and the lines in it, told in a language."""

    board: Board
    lang: str
    lines: tuple[Line, ...] = ()

    @property
    def figure(self) -> Figure:
        """The picture."""
        return _figure(self)

    @property
    def alt(self) -> str:
        """The picture in words, without drawing it."""
        words, board = table(self.lang, "figures")["board"], self.board
        told = words["solved" if self.lines else "empty"]
        told += words["field"].format(*map(given, board.view), *map(given, board.grid))
        if board.given:
            told += words["given"].format(_lines(board.given))
        if board.marks:
            marks = "; ".join(f"{name(label)} {_point(point)}" for label, point in board.marks)
            told += words["marks"].format(marks)
        told += words["wanted"].format(_lines(self.lines)) if self.lines else ""
        return numbers_in(self.lang, told)


@lru_cache(maxsize=256)
def _figure(drawing: Drawing) -> Figure:
    from quizgen.figures._canvas import Canvas, Style
    from quizgen.figures._pen import BOLD, GREY, LABEL, RED, Pen

    board = drawing.board
    pen = Pen(*board.picture)
    _axes(pen, board)
    for line in board.given:
        pen.line(
            "given", [board.place(point) for point in line], Style(1.4, GREY.colour, (5.0, 2.0))
        )
    for line in drawing.lines:
        pen.line("wanted", [board.place(point) for point in line], BOLD)
    for label, point in board.marks:
        x, y = board.place(point)
        pen.dot("marks", (x, y), 2.2, Style(colour=RED.colour))
        pen.label((x + 3, y + LABEL * 0.8), label, "l")
    canvas = Canvas()
    pen.onto(canvas)
    return Figure(canvas.written_in(drawing.lang), drawing.alt, drawing.lang, "invert")


def _axes(pen: Pen, board: Board) -> None:
    from quizgen.figures._canvas import Style
    from quizgen.figures._pen import THIN

    left, right, low, high = board.view
    fine, axis, size = Style(0.4, "#d5dae1"), Style(0.6, "#9aa3af"), 7.5
    for x in _ticks(left, right, board.grid[0]):
        foot, top = board.place((x, low)), board.place((x, high))
        pen.line("grid", [foot, top], fine if x else axis)
        pen.label((foot[0], foot[1] - 8), given(x), "c", size)
    for y in _ticks(low, high, board.grid[1]):
        start, end = board.place((left, y)), board.place((right, y))
        pen.line("grid", [start, end], fine if y else axis)
        pen.label((start[0] - 4, start[1]), given(y), "r", size)
    corners = [(left, low), (right, low), (right, high), (left, high)]
    pen.area("frame", [board.place(corner) for corner in corners], THIN)


def _ticks(first: float, last: float, step: float) -> Iterator[float]:
    slack = 1e-9 * (last - first)
    for count in range(ceil((first - slack) / step), floor((last + slack) / step) + 1):
        yield round(count * step, 9) + 0.0


def _lines(lines: tuple[Line, ...]) -> str:
    return "; ".join(", ".join(map(_point, line)) for line in lines)


def _point(point: Point) -> str:
    return "({}; {})".format(*(given(round(value, 3)) for value in point))
