"""Veiling glare: light that strays inside the lens and lies over the whole picture."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, on_composite
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import SHARE, Setting
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import View

FLARE = Setting("flare", quantity_parser("%"), 0.0, (SHARE,))
"""Share of the light that is spread evenly (the veiling glare index of ISO 9358)."""


def run(image: Image, view: View) -> Image:
    """Return the picture with a share of all light spread evenly over it; the mean stays."""
    share = view.camera[FLARE]
    veil = share * image.mean(axis=(0, 1), dtype=np.float64)
    return np.asarray(image * (1.0 - share) + veil.astype(image.dtype))


EFFECT = Effect(
    name="flare",
    answers=("flare", "contrast", "artefacts"),
    settings=(FLARE,),
    is_present=lambda view: view.camera[FLARE] > 0.0,
    run=on_composite(run),
    # the mean lies inside the range, so that a pixel is at most the whole range away from it
    omission_bound=lambda signal, view: view.camera[FLARE] * signal.span,
    size=EffectSize(
        lambda view: 100.0 * view.camera[FLARE], "spread {:.3g} % of the light over the picture"
    ),
)
