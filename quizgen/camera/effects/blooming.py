"""Blooming: charge above the full well spills along the column."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.effect import Effect, on_composite
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import NEEDS_FULL_WELL, Setting
from quizgen.camera.setup.value_parsers import parse_bool
from quizgen.camera.setup.view import Signal, View

BLOOMING = Setting("blooming", parse_bool, False, (NEEDS_FULL_WELL,))


def run(image: Image, view: View) -> Image:
    """Return the picture after charge above the full well spilled along columns, half each way.

    Of one sensor with colour filters: the sites for red, green and blue of a pixel follow each
    other in its column and fill whatever the colour of what spills, so that a streak is white. Each
    keeps what it can; what reaches the border is drained.
    """
    result = image.copy()
    full = np.flatnonzero(image.max(axis=(0, 2)) > 1.0)
    for start in range(0, full.size, _COLUMNS):
        some = full[start : start + _COLUMNS]
        sites = image[:, some].swapaxes(1, 2).reshape(-1, some.size)
        half = np.maximum(sites - 1.0, 0.0) * 0.5
        drained = _spill(_spill(np.minimum(sites, 1.0), half)[::-1], half[::-1])[::-1]
        result[:, some] = drained.reshape(len(image), -1, some.size).swapaxes(1, 2)
    return result


_COLUMNS = 1024
"""Columns worked on at once: others have nothing to spill."""


def _spill(kept: Image, excess: Image) -> Image:
    """Return charge with the excess carried down to the next rows until they have room for it."""
    filled, carried = kept.copy(), np.zeros(kept.shape[1:], kept.dtype)
    spilling = np.flatnonzero(excess.any(axis=1))
    for row in range(spilling[0] if spilling.size else len(kept), len(kept)):
        level = filled[row] + carried
        filled[row] = np.minimum(level, 1.0)
        carried = level - filled[row] + excess[row]
        if row >= spilling[-1] and not carried.any():
            break
    return filled


def omission_bound(signal: Signal, view: View) -> float:
    """Return 0 for signals below the full well, else what filling a column can change."""
    return 0.0 if signal.high <= 1.0 else max(signal.high - 1.0, 1.0 - signal.low)


def carry_error(error: float, signal: Signal, view: View) -> float:
    """Return the error after spilling: that of all sites of a column may add up in one."""
    if signal.high + error <= 1.0:
        return error
    filled = max(1.0 - (signal.low - error), error)
    return min((3.0 * view.height + 1.0) * error, filled)


EFFECT = Effect(
    name="blooming",
    answers=("blooming", "saturation", "artefacts"),
    settings=(BLOOMING,),
    is_present=lambda view: view.camera[BLOOMING],
    run=on_composite(run),
    omission_bound=omission_bound,
    carry_error=carry_error,
    range_after=lambda signal, _: signal.clip_range(-math.inf, 1.0),
)
