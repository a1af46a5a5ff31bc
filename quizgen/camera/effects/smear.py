"""Smear: a bright streak through the whole column of a CCD."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, on_composite
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import NEEDS_FULL_WELL, SHARE, Setting
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import Signal, View

SMEAR = Setting("smear", quantity_parser("%"), 0.0, (NEEDS_FULL_WELL, SHARE))
"""Share of a column's mean that is added to the column while its rows are shifted."""


def run(image: Image, view: View) -> Image:
    """Return the picture plus a share of each column's mean.

    It is the light that falls in while a CCD shifts its rows.
    """
    mean = image.mean(axis=0, keepdims=True, dtype=np.float64)
    return np.asarray(image + (view.camera[SMEAR] * mean).astype(image.dtype))


def range_after(signal: Signal, view: View) -> Signal:
    """Return the range, brighter by the share of the column's mean."""
    share = view.camera[SMEAR]
    return signal.with_margins(share * max(-signal.low, 0.0), share * max(signal.high, 0.0))


EFFECT = Effect(
    name="smear",
    answers=("smear", "saturation", "artefacts"),
    settings=(SMEAR,),
    is_present=lambda view: view.camera[SMEAR] > 0.0,
    run=on_composite(run),
    omission_bound=lambda signal, view: view.camera[SMEAR] * signal.size,
    carry_error=lambda error, _, view: error * (1.0 + view.camera[SMEAR]),
    range_after=range_after,
    size=EffectSize(
        lambda view: 100.0 * view.camera[SMEAR], "add {:.3g} % of each column's mean to it"
    ),
)
