"""Blooming: charge above the full well spills along the column."""

from __future__ import annotations

import math

import numpy as np
from msgspec.structs import replace

from quizgen.camera.body import NEEDS_FULL_WELL
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, on_picture
from quizgen.camera.facts import Error, Facts, mean_size
from quizgen.camera.scene import Image
from quizgen.camera.settings import Setting
from quizgen.camera.values import truth
from quizgen.camera.view import View

BLOOMING = Setting("blooming", truth, False, (NEEDS_FULL_WELL,))


def run(image: Image, view: View, rung: str = "") -> Image:
    """Charge above the full well spills along the column, half up and half down.

    Each photosite keeps what it can; what reaches the border is drained.
    """
    result = image.copy()
    columns = result.reshape(len(image), -1)
    full = np.flatnonzero(columns.max(axis=0) > 1.0)
    for start in range(0, full.size, _COLUMNS):
        some = full[start : start + _COLUMNS]
        columns[:, some] = _drained(columns[:, some])
    return result


_COLUMNS = 3072
"""Columns of one colour worked on at once: others have nothing to spill."""


def _drained(columns: Image) -> Image:
    half = np.maximum(columns - 1.0, 0.0) * 0.5
    kept = np.minimum(columns, 1.0)
    return _spill(_spill(kept, half)[::-1], half[::-1])[::-1]


def _spill(kept: Image, excess: Image) -> Image:
    """Carry excess to the next rows until it finds room."""
    filled, carried = kept.copy(), np.zeros(kept.shape[1:], kept.dtype)
    spilling = np.flatnonzero(excess.any(axis=1))
    for row in range(spilling[0] if spilling.size else len(kept), len(kept)):
        level = filled[row] + carried
        filled[row] = np.minimum(level, 1.0)
        carried = level - filled[row] + excess[row]
        if row >= spilling[-1] and not carried.any():
            break
    return filled


def _overflows(facts: Facts, error: float = 0.0) -> bool:
    return facts.top + error > 1.0


def skipped(facts: Facts, view: View) -> Error:
    """Nothing below the full well but what rounding carries over it; else a filled column."""
    if not _overflows(facts):
        return Error(min(view.height * facts.just_above(1.0), 1.0 - facts.bottom))
    return Error(max(facts.top - 1.0, 1.0 - facts.bottom))


def carried(error: Error, facts: Facts, view: View) -> Error:
    """Spilt charge adds up along a column: whatever any of its rows may be off by."""
    if not _overflows(facts, error.certain):
        return error
    added = error.sure + mean_size(error.sigma, view.height)
    filled = 1.0 - min(facts.bottom - error.certain, 0.0)
    spilt = math.inf if error.odd else view.height * added + error.certain
    return Error(min(spilt, filled))


def after(facts: Facts, view: View) -> Facts:
    """A filled column is a step of the whole range."""
    if not _overflows(facts):
        return facts
    full = replace(facts, low=min(facts.low, 1.0), high=1.0).between(-math.inf, 1.0)
    return full.with_jump((full.span + full.reach, full.span + full.reach))


EFFECT = Effect(
    name="blooming",
    stage="sensor",
    decides=("blooming", "saturation", "artefacts"),
    settings=(BLOOMING,),
    present=lambda view: view.camera[BLOOMING],
    run=on_picture(run),
    cost=measured((9.37, 215)),
    skipped=skipped,
    carried=carried,
    after=after,
)
