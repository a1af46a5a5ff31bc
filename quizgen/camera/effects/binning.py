"""Binning: blocks of pixels become one, as if the photosites were that much larger."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, on_composite
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import Setting, in_range
from quizgen.camera.setup.value_parsers import parse_integer
from quizgen.camera.setup.view import View

BINNING = Setting("binning", parse_integer, 1, (in_range(1, 1000, "px"),))
"""Side of a block, px."""


def run(image: Image, view: View) -> Image:
    """Return the mean of every block of pixels, shown as large as the block.

    Border blocks may be cut.
    """
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
    answers=("resolution", "sampling", "artefacts"),
    settings=(BINNING,),
    is_present=lambda view: view.camera[BINNING] > 1,
    run=on_composite(run),
    omission_bound=lambda signal, _: signal.span,
    size=EffectSize(
        lambda view: view.camera[BINNING], "make one pixel of blocks {:.3g} px wide", 2.0
    ),
)
