"""Vignetting: less light toward the corners.

It stands after motion: the lens stands still, so its fixed factor can be
taken out of the integral over the exposure.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, PointByPoint
from quizgen.camera.pixels.tiles import TileOperation, multiply_by_map
from quizgen.camera.raster.layers import Field
from quizgen.camera.setup.scene import Image, Precision
from quizgen.camera.setup.settings import NEEDS_LENS, Setting, SettingRule
from quizgen.camera.setup.value_parsers import parse_bool, parse_plain_number
from quizgen.camera.setup.view import View

NATURAL = Setting("natural_vignetting", parse_bool, False, (NEEDS_LENS,))
"""cos^4 fall-off."""
MECHANICAL = Setting(
    "mechanical_vignetting",
    parse_plain_number,
    0.0,
    (SettingRule[float](lambda shift, _: 0 <= shift < 1, "must be in [0, 1)"),),
)
"""Shift of the lens rim at the corner in aperture diameters."""


def rim_overlap(shift: Field) -> Field:
    """Return the common area of two equal discs, as a share of one; ``shift`` is in diameters."""
    half = np.clip(shift, 0.0, 1.0)
    return np.asarray((2.0 / math.pi) * (np.arccos(half) - half * np.sqrt(1.0 - half * half)))


def light_falloff(radius: Field, view: View) -> Field:
    """Return the share of light kept at a distance from the principal point in px.

    Natural: cos^4 of the field angle, (1 + (r/f)^2)^-2. Mechanical: lens rim and aperture as two
    discs that slide apart, by ``mechanical_vignetting`` diameters at the corner.
    """
    focal, mechanical = _lens_key(view)
    kept: Field = 1.0 / (1.0 + (radius / focal) ** 2) ** 2 if focal else np.ones_like(radius)
    return kept * rim_overlap(mechanical * radius / view.corner) if mechanical else kept


def _lens_key(view: View) -> tuple[float, float]:
    """Return the focal length in px (0 without natural fall-off) and the shift of the rim."""
    return view.focal if view.camera[NATURAL] else 0.0, view.camera[MECHANICAL]


def falloff_map(view: View) -> Image:
    """Return the share of light kept at every pixel, shape (H, W, 1)."""
    return _fall_off_map(view.width, view.height, *_lens_key(view), view.precision)


@lru_cache(maxsize=2)
def _fall_off_map(
    width: int, height: int, focal: float, mechanical: float, precision: Precision
) -> Image:
    """Return the map of a whole picture, cached."""
    x, y = (width - 1) / 2, (height - 1) / 2
    squared = (np.arange(width)[None, :] - x) ** 2 + (np.arange(height)[:, None] - y) ** 2
    kept: Field = 1.0 / (1.0 + squared / focal**2) ** 2 if focal else np.ones_like(squared)
    if mechanical:
        kept = kept * rim_overlap(mechanical * np.sqrt(squared) / math.hypot(x, y))
    return kept.astype(precision)[..., None]


def operation(view: View) -> TileOperation:
    """Return what multiplies a tile by the share of light kept."""
    return multiply_by_map(falloff_map(view))


def corner_falloff(view: View) -> float:
    """Return the share of light kept at the picture's corner."""
    return float(light_falloff(np.array([view.corner]), view)[0])


def is_present(view: View) -> bool:
    """Return whether the lens loses light toward the corners."""
    return view.camera[NATURAL] or view.camera[MECHANICAL] > 0.0


EFFECT = Effect(
    name="vignetting",
    answers=("vignetting", "artefacts"),
    settings=(NATURAL, MECHANICAL),
    is_present=is_present,
    run=PointByPoint(operation),
    omission_bound=lambda signal, view: (1.0 - corner_falloff(view) + 1e-6) * signal.size,
    range_after=lambda signal, view: signal.scale_range(corner_falloff(view) * (1.0 - 1e-6), 1.0),
    size=EffectSize(
        lambda view: 100.0 * (1.0 - corner_falloff(view)), "darken the corners by {:.3g} %", 5.0
    ),
)
