"""Photographs inside a figure, thinly framed, and their histograms. Loads NumPy."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Box = tuple[float, float, float, float]
"""Left, low, width and height in points of the figure."""


_TALLEST = 4
"""A bar that is so many times as tall as the second one is cut, with a mark of breaking."""


def check_seen(
    shown: NDArray[np.uint8], plain: NDArray[np.uint8], kind: str, *, speckles: bool = False,
    grey: bool = True,
) -> None:  # fmt: skip
    """Raise an error if nobody sees in a picture what it is asked about.

    Parameters
    ----------
    shown, plain : ndarray of uint8
        The picture, and the same without what is asked.
    kind : str
        What is asked, for the message.
    speckles : bool
        Whether it is noise, which is seen by the spread of single pixels.
    grey : bool
        Whether it must be seen in a greyscale print, too: unless the figure says ``COLOUR``.

    Raises
    ------
    InvisibleEffectError
        With how little of it is seen.
    """
    from quizgen.camera.question_photo import check_visible, measure_visibility

    check_visible(measure_visibility(shown, plain, kind, speckles=speckles), grey=grey)


def place_photo(
    fig: Any, codes: NDArray[np.uint8], box: Box, *, palette: Any = None, number: int = 0,
    told: str = "",
) -> None:  # fmt: skip
    """Draw a photograph in a box of the figure, with a frame.

    Parameters
    ----------
    fig : Figure
        Of matplotlib, in points.
    codes : ndarray of uint8, shape (H, W) or (H, W, 3)
        Grey levels or colours; with a palette, shape (H, W), indices of its colours.
    box : tuple of float
        Left, low, width and height in points; a caption takes 14 above.
    palette : sequence of (red, green, blue), optional
        Up to 256 colours, 0 to 255.
    number : int
        Written above; 0 writes none.
    told : str
        Text after the number, which a quiz hides.
    """
    fig.picture(codes, box, palette, gid="photographs")
    left, low, wide, high = box
    right, top = left + wide, low + high
    art = fig.sketch()
    corners = [(left, low), (right, low), (right, top), (left, top)]
    art.area(corners, None, "grey", 0.5, part="frames")
    if number:
        art.label((left + 0.5, top + 3.5), str(number), "lb", 11)
    if told:
        art.label((left + 13 * bool(number), top + 3.5), told, "lb", 10, "red", part="answer")


def plot_histogram(fig: Any, codes: NDArray[np.uint8], bins: int, box: Box) -> None:
    """Draw the histogram of a grey picture: filled steps over an axis of grey levels.

    Parameters
    ----------
    fig : Figure
        Of matplotlib, in points.
    codes : ndarray of uint8
        Grey levels.
    bins : int
        How many; a divisor of 256, as bins of different widths would make teeth.
    box : tuple of float
        Of the bars, in points; the tallest fills it, and is cut where it dwarfs the others. The
        numbers take 13 points below, the names of the axes 10 to the right and 14 above.
    """
    left, low, wide, high = box
    art = fig.sketch()
    counts = np.bincount(codes.ravel() // (256 // bins), minlength=bins)
    edges = np.repeat(np.linspace(left, left + wide, bins + 1), 2)
    second, most = np.partition(counts, -2)[-2:].tolist()
    shown = min(_TALLEST * second, most) or most
    tops = np.concatenate([[0], np.repeat(np.minimum(counts, shown), 2), [0]])
    art.area(np.column_stack([edges, low + high / shown * tops]), "blue", part="histogram")
    if shown < most:
        bar, y = left + wide * (float(counts.argmax()) + 0.5) / bins, low + 0.8 * high
        gap = [(bar - 3, y - 2.2), (bar + 3, y + 0.2), (bar + 3, y + 2.2), (bar - 3, y - 0.2)]
        art.area(gap, "paper", part="break")
        for edge in (gap[:2], gap[2:]):
            art.line(edge, "ink", 0.6, part="break")
    ticks = [left + wide * level / 256 for level in (0, 64, 128, 192, 255)]
    teeth = [(x, y) for x in ticks for y in (low, low - 2.5, low)]
    axes = [(left, low + high + 3), *teeth, (left + wide + 3, low)]
    art.line(axes, "ink", 0.7, part="axes")
    for x, level in zip(ticks[::2], ("0", "128", "255"), strict=True):
        art.label((x, low - 4.5), level, "ct", 8.5)
    art.label((left + wide + 5, low), "$I$", "l", 9)
    art.label((left - 1, low + high + 5), "$h(I)$", "lb", 9)
