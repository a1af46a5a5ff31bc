"""8-bit codes of pictures, their histograms, and what can be read off them by name."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

GREY_LEVELS = 255.0


def to_8bit(values: NDArray[np.floating]) -> NDArray[np.uint8]:
    """Return 8-bit codes of values in [0, 255]: clipped, halves rounded upward.

    Nothing is truncated (errata EC8), nothing wraps (errata E21); OpenCV's demosaicing rounds so,
    too.
    """
    return np.asarray(np.clip(values + 0.5, 0, 255), np.uint8)  # which leaves out the fraction


def count_histogram(image: NDArray[np.floating], bins: int) -> NDArray[np.int64]:
    """Return the counts of values in equal bins over [0, 1]; values outside go to the end bins."""
    index = np.clip((image.astype(np.float64) * bins).astype(np.int64), 0, bins - 1)
    return np.bincount(index.reshape(-1), minlength=bins)


def _average_patch(levels: NDArray[np.floating], down: float, across: float) -> float:
    """Return the mean of a patch (1/16 of each side) at relative position (0 to 1)."""
    height, width = levels.shape[:2]
    rows, columns = max(1, height // 16), max(1, width // 16)
    top, left = int((height - rows) * down), int((width - columns) * across)
    return float(levels[top : top + rows, left : left + columns].mean())


_CORNERS = (0, 0), (0, 1), (1, 0), (1, 1)

MEASURES = {
    "mean": lambda levels: float(levels.mean()),
    "centre": lambda levels: _average_patch(levels, 0.5, 0.5),
    "corner": lambda levels: float(np.mean([_average_patch(levels, *place) for place in _CORNERS])),
    "deviation": lambda levels: float(levels.std(axis=(0, 1)).mean()),
    "darkest": lambda levels: float(levels.min()),
    "brightest": lambda levels: float(levels.max()),
}
"""What can be read off a picture by name, in grey levels from 0 to 255."""
