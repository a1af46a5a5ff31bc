"""Vignetting: less light toward the corners.

It stands after motion: the lens stands still, so its fixed factor can be
taken out of the integral over the exposure.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from quizgen.camera.blocks import Work, at_pixels
from quizgen.camera.effects.effect import (
    Effect,
    PointByPoint,
    Size,
)
from quizgen.camera.raster.layers import Field
from quizgen.camera.scene import Image, Precision
from quizgen.camera.setup.body import NEEDS_LENS
from quizgen.camera.setup.settings import Rule, Setting, Settings
from quizgen.camera.setup.values import number, truth
from quizgen.camera.view import View


def _below_one(shift: float, _: Settings) -> bool:
    return 0 <= shift < 1


NATURAL = Setting("natural_vignetting", truth, False, (NEEDS_LENS,))
"""cos^4 fall-off."""
MECHANICAL = Setting(
    "mechanical_vignetting",
    number,
    0.0,
    (Rule(_below_one, "must be in [0, 1)"),),
)
"""Shift of the lens rim at the corner in aperture diameters."""


def rim_overlap(shift: Field) -> Field:
    """Area shared by two equal discs, as a share of one, at a shift in diameters (0 to 1)."""
    half = np.clip(shift, 0.0, 1.0)
    return np.asarray((2.0 / math.pi) * (np.arccos(half) - half * np.sqrt(1.0 - half * half)))


def fall_off(radius: Field, view: View) -> Field:
    """Share of light kept at a distance from the principal point, px.

    Natural: cos^4 of the field angle, (1 + (r/f)^2)^-2. Mechanical: lens rim and aperture as two
    discs that slide apart, by ``mechanical_vignetting`` diameters at the corner.
    """
    return _kept(radius, *_lens(view))


def _lens(view: View) -> tuple[float, float, float]:
    """Focal length (0 without the natural fall-off), the rim's shift and where, px."""
    camera = view.camera
    return view.focal if camera[NATURAL] else 0.0, camera[MECHANICAL], view.corner


def _kept(radius: Field, focal: float, mechanical: float, corner: float) -> Field:
    kept: Field = 1.0 / (1.0 + (radius / focal) ** 2) ** 2 if focal else np.ones_like(radius)
    if mechanical:
        kept = kept * rim_overlap(mechanical * radius / corner)
    return kept


def fall_off_map(view: View) -> Image:
    """`fall_off` at every pixel, shape (H, W, 1)."""
    focal, mechanical, _ = _lens(view)
    return _fall_off_map(view.width, view.height, focal, mechanical, view.precision)


@lru_cache(maxsize=2)
def _fall_off_map(
    width: int, height: int, focal: float, mechanical: float, precision: Precision
) -> Image:
    """One quadrant, mirrored."""
    x, y = (width - 1) / 2, (height - 1) / 2
    right, lower = np.arange((width + 1) // 2) - x, np.arange((height + 1) // 2) - y
    squared = right[None, :] ** 2 + lower[:, None] ** 2
    kept: Field = 1.0 / (1.0 + squared / focal**2) ** 2 if focal else np.ones_like(squared)
    if mechanical:
        kept = kept * rim_overlap(mechanical * np.sqrt(squared) / math.hypot(x, y))
    kept = np.concatenate([kept, kept[:, width // 2 - 1 :: -1]], axis=1)
    kept = np.concatenate([kept, kept[height // 2 - 1 :: -1]], axis=0)
    return kept.astype(precision)[..., None]


def work(view: View) -> Work:
    """Multiply by the fall-off map."""
    return at_pixels(fall_off_map(view))


def corner_light(view: View) -> float:
    """Share of light kept at the picture's corner."""
    focal, mechanical, corner = _lens(view)
    return float(_kept(np.array([corner]), focal, mechanical, corner)[0])


def is_present(view: View) -> bool:
    """Whether the lens loses light toward the corners."""
    return view.camera[NATURAL] or view.camera[MECHANICAL] > 0.0


EFFECT = Effect(
    name="vignetting",
    stage="sensor",
    answers=("vignetting", "artefacts"),
    settings=(NATURAL, MECHANICAL),
    is_present=is_present,
    run=PointByPoint(work),
    omission_bound=lambda signal, view: (1.0 - corner_light(view) + 1e-6) * signal.size,
    range_after=lambda signal, view: signal.scaled(corner_light(view) * (1.0 - 1e-6), 1.0),
    size=Size(
        lambda view: 100.0 * (1.0 - corner_light(view)), "darken the corners by {:.3g} %", 5.0
    ),
)
