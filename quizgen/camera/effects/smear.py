"""Smear: a bright streak through the whole column of a CCD."""

from __future__ import annotations

import numpy as np
from msgspec.structs import replace

from quizgen.camera.body import NEEDS_FULL_WELL
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, on_picture
from quizgen.camera.facts import Error, Facts, mean_size
from quizgen.camera.scene import Image
from quizgen.camera.settings import SHARE, Setting
from quizgen.camera.values import quantity
from quizgen.camera.view import View

SMEAR = Setting("smear", quantity("%"), 0.0, (NEEDS_FULL_WELL, SHARE))
"""Share of a column's mean that is added to the column while its rows are shifted."""


def run(image: Image, view: View, rung: str = "") -> Image:
    """Light that falls in while a CCD shifts its rows: a share of each column's mean."""
    mean = image.mean(axis=0, keepdims=True, dtype=np.float64)
    return np.asarray(image + (view.camera[SMEAR] * mean).astype(image.dtype))


def skipped(facts: Facts, view: View) -> Error:
    """Share of the brightest possible column."""
    return Error(view.camera[SMEAR] * facts.in_columns(view.height))


def carried(error: Error, facts: Facts, view: View) -> Error:
    """The column's mean carries the error again; its luck is that of all its rows."""
    mean = error.sure + mean_size(error.sigma, view.height)
    if error.odd:  # no column has more odd values than these
        several = min(1.0, 12.0 / view.height + 10.0 * error.odd)
        mean += several * (facts.top - facts.bottom)
    return error.plus(Error(view.camera[SMEAR] * mean))


def after(facts: Facts, view: View) -> Facts:
    """Brighter; steps between columns grow."""
    grown, low = facts.scaled(1.0 + view.camera[SMEAR]), facts.limits[0]
    return replace(grown, limits=(min(low, grown.limits[0]), grown.limits[1]))


EFFECT = Effect(
    name="smear",
    stage="sensor",
    decides=("smear", "saturation", "artefacts"),
    settings=(SMEAR,),
    present=lambda view: view.camera[SMEAR] > 0.0,
    run=on_picture(run),
    cost=measured((0.443, 45.3)),
    skipped=skipped,
    carried=carried,
    after=after,
)
