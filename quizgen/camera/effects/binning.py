"""Binning: blocks of pixels become one, as if the photosites were that much larger."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effects.effect import (
    Effect,
    Size,
    on_picture,
)
from quizgen.camera.scene import Image
from quizgen.camera.setup.settings import Setting, between
from quizgen.camera.setup.values import whole
from quizgen.camera.view import View

BINNING = Setting("binning", whole, 1, (between(1, 1000, "px"),))
"""Side of a block, px."""


def run(image: Image, view: View) -> Image:
    """Mean of every block, shown as large as the block; blocks at the far border may be cut."""
    side = view.camera[BINNING]
    sums, counts = image, np.ones((1, 1, 1), image.dtype)
    for axis, size in enumerate(image.shape[:2]):
        starts = np.arange(0, size, side)
        sums = np.add.reduceat(sums, starts, axis=axis, dtype=image.dtype)
        widths = np.diff(np.append(starts, size)).astype(image.dtype)
        counts = counts * widths.reshape([-1 if at == axis else 1 for at in range(3)])
    means = sums / counts
    shown = means.repeat(side, axis=0).repeat(side, axis=1)
    return shown[: image.shape[0], : image.shape[1]]


EFFECT = Effect(
    name="binning",
    stage="processing",
    answers=("resolution", "sampling", "artefacts"),
    settings=(BINNING,),
    is_present=lambda view: view.camera[BINNING] > 1,
    run=on_picture(run),
    omission_bound=lambda signal, _: signal.span,
    size=Size(lambda view: view.camera[BINNING], "make one pixel of blocks {:.3g} px wide", 2.0),
)
