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
    """Divide out the vignetting of an even picture: linear data, mean brightness kept (E31)."""
    return multiply_by_map(flat_field_gains(falloff_map(view)))


def flat_field_gains(light: Image) -> Image:
    """Mean of a linear picture of an even surface over its values: what the gains are."""
    return float(light.mean(dtype=np.float64)) / light


def _most(view: View) -> float:
    """The largest factor: the mean lies between corner and centre."""
    return (1.0 + 1e-5) / corner_falloff(view)


EFFECT = Effect(
    name="flat field",
    answers=("flat field",),
    settings=(FLAT_FIELD,),
    is_present=lambda view: view.camera[FLAT_FIELD] and is_present(view),
    run=PointByPoint(operation),
    omission_bound=lambda signal, view: (_most(view) - 1.0) * signal.size,
    carry_error=lambda error, _, view: error * _most(view),
    range_after=lambda signal, view: signal.scale_range(1.0 / _most(view), _most(view)),
    size=EffectSize(
        lambda view: 100.0 * (_most(view) - 1.0),
        "brighten the corners by {:.3g} % against the centre",
    ),
    needs_effects=("vignetting",),
    needs="vignetting",
)
