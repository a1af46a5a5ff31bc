"""Photographs of the camera simulator inside a figure: framed, with bytes that never vary."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from quizgen.figures._pen import INK, LINE, THIN, Pen, Point
from quizgen.png import encode

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from quizgen.figures._canvas import Canvas

Box = tuple[float, float, float, float]
LETTERS = "ABCD"


def place(canvas: Canvas, pen: Pen, codes: NDArray[np.uint8], box: Box) -> None:
    """Put a photograph into a box of the figure and frame it."""
    left, low, wide, high = box
    canvas.picture(encode(codes), box)
    corners = [(left, low), (left + wide, low), (left + wide, low + high), (left, low + high)]
    pen.area("frames", corners, THIN)


def bars(pen: Pen, counts: Sequence[float], box: Box) -> list[Point]:
    """Draw a histogram as filled steps on a base line; the tallest bar is as high as the box.

    Returns
    -------
    list of Point
        Top middle of each bar.
    """
    left, low, wide, high = box
    step, tallest = wide / len(counts), max(counts)
    steps: list[Point] = [(left, low)]
    tops = []
    for place_, count in enumerate(counts):
        x, top = left + place_ * step, low + high * count / tallest
        steps += [(x, top), (x + step, top)]
        tops.append((x + step / 2, top))
    pen.area("histogram", [*steps, (left + wide, low)], INK)
    pen.line("axes", [(left, low), (left + wide, low)], LINE)
    return tops
