"""Flat field: vignetting divided out of the linear data."""

from __future__ import annotations

import numpy as np

from quizgen.camera.blocks import Work, at_pixels
from quizgen.camera.effects.effect import (
    Effect,
    PointByPoint,
    Size,
)
from quizgen.camera.effects.vignetting import corner_light, fall_off_map
from quizgen.camera.effects.vignetting import is_present as vignettes
from quizgen.camera.scene import Image
from quizgen.camera.setup.settings import Setting
from quizgen.camera.setup.values import truth
from quizgen.camera.view import View

FLAT_FIELD = Setting("flat_field", truth, False)


def work(view: View) -> Work:
    """Divide out the vignetting of an even picture: linear data, mean brightness kept (E31)."""
    return at_pixels(factors(fall_off_map(view), 0.0))


def factors(flat: Image, dark: Image | float) -> Image:
    """Mean of (flat - dark) over its values: what flat-field correction multiplies by.

    Parameters
    ----------
    flat, dark : numpy.ndarray
        Linear pictures of an even surface, and with the lens covered.

    Raises
    ------
    ValueError
        If a flat pixel is not brighter than its dark value (a dead pixel has no correction).
    """
    light = flat - dark
    if light.min() <= 0:
        raise ValueError("a flat pixel is not brighter than the dark frame")
    return float(light.mean(dtype=np.float64)) / light


def _most(view: View) -> float:
    """The largest factor: the mean lies between corner and centre."""
    return (1.0 + 1e-5) / corner_light(view)


EFFECT = Effect(
    name="flat field",
    stage="processing",
    answers=("flat field",),
    settings=(FLAT_FIELD,),
    is_present=lambda view: view.camera[FLAT_FIELD] and vignettes(view),
    run=PointByPoint(work),
    omission_bound=lambda signal, view: (_most(view) - 1.0) * signal.size,
    carry_error=lambda error, _, view: error * _most(view),
    range_after=lambda signal, view: signal.scaled(1.0 / _most(view), _most(view)),
    size=Size(
        lambda view: 100.0 * (_most(view) - 1.0),
        "brighten the corners by {:.3g} % against the centre",
    ),
    needs_effects=("vignetting",),
    needs="vignetting",
)
