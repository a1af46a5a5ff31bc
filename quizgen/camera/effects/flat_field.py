"""Flat field: vignetting divided out of the linear data."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, PointByPoint
from quizgen.camera.effects.vignetting import corner_falloff, falloff_map, is_present
from quizgen.camera.pixels.tiles import TileOperation, multiply_by_map
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import Setting
from quizgen.camera.setup.value_parsers import parse_bool
from quizgen.camera.setup.view import View

FLAT_FIELD = Setting("flat_field", parse_bool, False)


def operation(view: View) -> TileOperation:
    """Return what multiplies a tile by the gains that undo vignetting; the mean stays (E31)."""
    return multiply_by_map(flat_field_gains(falloff_map(view)))


def flat_field_gains(light: Image) -> Image:
    """Return the factors that even out a linear picture of an even surface: its mean over it."""
    return float(light.mean(dtype=np.float64)) / light


def _largest_gain(view: View) -> float:
    """Return a bound on the factors: the mean lies between corner and centre."""
    return (1.0 + 1e-5) / corner_falloff(view)


EFFECT = Effect(
    name="flat field",
    answers=("flat field",),
    settings=(FLAT_FIELD,),
    is_present=lambda view: view.camera[FLAT_FIELD] and is_present(view),
    run=PointByPoint(operation),
    omission_bound=lambda signal, view: (_largest_gain(view) - 1.0) * signal.size,
    carry_error=lambda error, _, view: error * _largest_gain(view),
    range_after=lambda signal, view: signal.scale_range(
        1.0 / _largest_gain(view), _largest_gain(view)
    ),
    size=EffectSize(
        lambda view: 100.0 * (_largest_gain(view) - 1.0),
        "brighten the corners by {:.3g} % against the centre",
    ),
    needs_effects=("vignetting",),
    needs="vignetting",
)
