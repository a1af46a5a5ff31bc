"""What plots share: many lines as one path, and values of a learner beside the right ones.

A learner's values are gold and have their number; what lies outside stands at the edge.
"""

from __future__ import annotations

from math import floor, log10
from typing import Any

import numpy as np
from matplotlib.path import Path

from quizgen.figures.kit import format_derived

Box = tuple[float, float, float, float]
"""Left, low, right and top of axes, in points of the figure."""


def trace_lines(lines: Any) -> Path:
    """Lines of equally many points, shape (lines, points, 2), as one path."""
    lines = np.asarray(lines, float)
    count, points = lines.shape[:2]
    codes = np.full((count, points), Path.LINETO)
    codes[:, 0] = Path.MOVETO
    return Path(lines.reshape(-1, 2), codes.ravel())


def format_learned(value: float) -> str:
    """Print a learner's number to 4 digits, what is huge or tiny with a power of ten."""
    if not value or 1e-5 <= abs(value) < 1e7:
        return format_derived(value)
    power = floor(log10(abs(value)))
    return rf"{format_derived(value / 10.0**power)} · $10^{{{power}}}$"


def mark_point(fig: Any, box: Box, at: tuple[float, float], label: str, *, side: int = 0) -> None:
    """Ring a point; one outside the box becomes an arrow at its edge.

    ``side`` is where the label stands, -1 left or 1 right; 0 is where there is more room.
    """
    art, (x, y), (right, up) = fig.sketch(zorder=6), *_clamp(box, at)
    if right or up:
        art.head((x, y), (right, up), "gold", 8, part="learned")
    else:
        art.dot((x, y), 3.2, "paper", "gold", 1.5, part="learned")
    side = side or (-1 if x > (box[0] + box[2]) / 2 else 1)
    art.label((x, y), label, _align(side), 9.5, "gold", shift=(7 * side, -8 * up), halo=True,
              part="learned")  # fmt: skip


def mark_place(fig: Any, box: Box, x: float, label: str, *, align: str = "") -> None:
    """Draw a line over the height of the box at a place of its level axis.

    The label stands beside its upper end, away from the middle, or with ``align`` above it.
    """
    art, (x, _), (out, _) = fig.sketch(zorder=6), *_clamp(box, (x, box[1]))
    side = 1 if x > (box[0] + box[2]) / 2 else -1
    at, beside = (x, box[3]), (3 * side, 0)
    if out:
        art.head((x, box[3] - 6), (out, 0), "gold", 8, part="learned")
        at, align, beside = (x, box[3]), _align(-side) + "b", (0, 1)
    else:
        art.line([(x, box[1]), at], "gold", 1.3, dashes=(4, 2), part="learned")
        align, beside = (align + "b", (0, 2)) if align else (_align(side), beside)
    art.label(at, label, align, 9.5, "gold", shift=beside, halo=True, part="learned")


def _align(side: int) -> str:
    return "l" if side > 0 else "r"


def _clamp(box: Box, at: tuple[float, float]) -> tuple[tuple[float, float], tuple[int, int]]:
    """The nearest point of a box, and the way from there, -1, 0 or 1 along each axis."""
    (x, y), low, high = at, box[:2], box[2:]
    inside = min(max(x, low[0]), high[0]), min(max(y, low[1]), high[1])
    way = [int(v > top) - int(v < foot) for v, foot, top in zip(at, low, high, strict=True)]
    return inside, (way[0], way[1])
