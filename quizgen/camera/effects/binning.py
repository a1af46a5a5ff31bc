"""Binning: blocks of pixels become one, as if the photosites were that much larger."""

from __future__ import annotations

import numpy as np
from msgspec.structs import replace

from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, on_picture
from quizgen.camera.facts import Error, Facts
from quizgen.camera.scene import Image
from quizgen.camera.settings import Setting, between
from quizgen.camera.values import whole
from quizgen.camera.view import View

BINNING = Setting("binning", whole, 1, (between(1, 1000, "px"),))
"""Side of a block, px."""


def run(image: Image, view: View, rung: str = "") -> Image:
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


def skipped(facts: Facts, view: View) -> Error:
    """The mean of a row of k values lies at most (k - 1)/2 steps from each of them.

    Noise of a pixel and of a mean that holds it: at most twice as far apart as either spreads.
    """
    apart = (view.camera[BINNING] - 1) / 2.0 * sum(facts.jump)
    return Error(min(apart, facts.span) + 2.0 * facts.tail, 2.0 * facts.noise)


def carried(error: Error, facts: Facts, view: View) -> Error:
    """Means do not grow; one pixel shows in its whole block."""
    return replace(error, odd=view.camera[BINNING] ** 2 * error.odd)


def after(facts: Facts, view: View) -> Facts:
    """The means of two blocks are as many steps apart as their middles."""
    side = view.camera[BINNING]
    return facts.with_jump((side * facts.jump[0], side * facts.jump[1]))


EFFECT = Effect(
    name="binning",
    stage="processing",
    decides=("resolution", "sampling", "artefacts"),
    settings=(BINNING,),
    present=lambda view: view.camera[BINNING] > 1,
    run=on_picture(run),
    cost=measured((10.3, 638)),
    skipped=skipped,
    carried=carried,
    after=after,
)
