"""What drawings of optics share: the lens, the optical axis, and where a learner's value goes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.path import Path


def draw_lines(
    art: Any,
    lines: Iterable[Any],
    stroke: str = "rule",
    width: float = 0.6,
    *,
    part: str = "helpers",
) -> None:
    """Draw lines that look alike as one path; each has the same number of points."""
    points = np.array(list(lines), float)
    codes = [Path.MOVETO, *[Path.LINETO] * (points.shape[1] - 1)] * len(points)
    art.shape(Path(points.reshape(-1, 2), codes), None, stroke, width, part=part)


def draw_axis(art: Any, left: float, right: float, height: float) -> None:
    """Draw the optical axis."""
    ends = [(left, height), (right, height)]
    art.line(ends, "grey", 0.6, dashes=(9, 2, 1.5, 2), part="axis")


def draw_lens(art: Any, x: float, height: float, half: float) -> None:
    """Draw a thin lens with its middle plane, where rays are bent."""
    top, low, bulge = (x, height + half), (x, height - half), 14.0
    sides = [(x + bulge, height), low, (x - bulge, height), top]
    outline = Path([top, *sides, top], [Path.MOVETO, *[Path.CURVE3] * 4, Path.CLOSEPOLY])
    art.shape(outline, "pale-blue", "blue", 0.9, part="lens")
    art.line([low, top], "blue", 0.5, dashes=(2, 2), part="lens-plane")


def clamp(place: float, low: float, high: float) -> tuple[float, int]:
    """Keep a place between two edges; the second number says which edge it left, -1, 0 or 1."""
    return min(max(place, low), high), int(place > high) - int(place < low)
