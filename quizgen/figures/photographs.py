"""Pictures inside a figure, framed, with their histograms; bytes that never vary. Loads NumPy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from quizgen.camera.codes import histogram as counted
from quizgen.figures._pen import INK, LINE, THIN, Pen, Point

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from quizgen.figures._canvas import Box, Canvas


def place(canvas: Canvas, pen: Pen, codes: NDArray[np.uint8], box: Box) -> None:
    """Put a photograph into a box of the figure and frame it."""
    framed(canvas, pen, codes, box)


def framed(canvas: Canvas, pen: Pen, pixels: bytes | NDArray[np.uint8], box: Box) -> None:
    """Put a PNG file, or 8-bit codes, into a box of the figure and frame it."""
    left, low, wide, high = box
    canvas.picture(pixels, box)
    corners = [(left, low), (left + wide, low), (left + wide, low + high), (left, low + high)]
    pen.area("frames", corners, THIN)


def histogram(pen: Pen, codes: NDArray[np.uint8], bins: int, box: Box) -> None:
    """Draw the histogram of a grey picture, with 0 and 255 below its ends."""
    left, low, wide, _ = box
    bars(pen, [float(count) for count in counted(codes[..., None], bins, top=255)], box)
    pen.label((left, low - 7), "0", "l", 8.5)
    pen.label((left + wide, low - 7), "255", "r", 8.5)


def bars(pen: Pen, counts: Sequence[float], box: Box) -> None:
    """Draw a histogram as filled steps on a base line; the tallest bar is as high as the box."""
    left, low, wide, high = box
    step, tallest = wide / len(counts), max(counts)
    steps: list[Point] = [(left, low)]
    for number, count in enumerate(counts):
        x, top = left + number * step, low + high * count / tallest
        steps += [(x, top), (x + step, top)]
    pen.area("histogram", [*steps, (left + wide, low)], INK)
    pen.line("axes", [(left, low), (left + wide, low)], LINE)
