"""Photographs of the camera simulator inside a figure: framed, with bytes that never vary."""

from __future__ import annotations

from collections.abc import Sequence
from struct import pack
from typing import TYPE_CHECKING, Any

from quizgen.figures._pen import INK, LINE, THIN, Pen, Point
from quizgen.figures._png import _chunk, deflate

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

Box = tuple[float, float, float, float]
LETTERS = "ABCD"


def photo_png(codes: NDArray[Any]) -> bytes:
    """Encode 8-bit codes.

    Parameters
    ----------
    codes : ndarray of uint8, shape (H, W, 3) or (H, W)
        Three equal channels are stored as one.

    Returns
    -------
    bytes
        A PNG file, the same with every version of zlib.
    """
    import numpy as np

    if codes.ndim == 3 and np.array_equal(codes[..., :1].repeat(3, axis=2), codes):
        codes = codes[..., 0]
    height, width = codes.shape[:2]
    rows = codes.reshape(height, -1)
    upward = np.diff(rows, axis=0, prepend=rows[:1] * 0)  # flat areas become runs of zeros
    filtered = np.pad(upward, ((0, 0), (1, 0)), constant_values=2)
    header = pack(">IIBBBBB", width, height, 8, 0 if codes.ndim == 2 else 2, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", deflate(filtered.ravel())), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in chunks)


def place(figure: Figure, pen: Pen, codes: NDArray[Any], box: Box) -> None:
    """Put a photograph into a box of the figure and frame it."""
    from quizgen.figures._picture import Picture

    left, low, wide, high = box
    figure.add_artist(Picture(photo_png(codes), box))
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
