"""Exposure: light by aperture and shutter, and a correction of 2^stops."""

from __future__ import annotations

import math

from quizgen.camera.effects.gain import amplifier
from quizgen.camera.setup.body import SHUTTER, aperture
from quizgen.camera.setup.settings import Rule, Setting, Settings, between
from quizgen.camera.setup.values import number, quantity
from quizgen.camera.view import View

EXPOSURE = Setting("exposure", quantity("stop"), 0.0, (between(-40.0, 40.0, "stop"),))
"""Correction in stops; +1 doubles."""


def _lets_light_in(_: object, camera: Settings) -> bool:
    return aperture(camera) is not None and camera[SHUTTER] > 0.0


LIGHT_VALUE = Setting[float | None](
    "light_value",
    number,
    None,
    (between(-20.0, 30.0), Rule(_lets_light_in, "needs shutter, and f_number or pinhole")),
)
"""Brightness of the scene: the exposure value for ISO 100 that makes radiance 1 white."""


def exposure_value(view: View) -> float:
    """log2(N^2/t), as on a light meter set to ISO 100 (ISO 2720)."""
    return math.log2(view.f_number**2 / view.camera[SHUTTER])


def factor(view: View) -> float:
    """What radiance is multiplied by, up to the photosites; `quizgen.camera.effects.gain` follows.

    Without a light value the picture is metered: f-number and shutter do not change it.
    """
    stops, light = view.camera[EXPOSURE], view.camera[LIGHT_VALUE]
    if light is not None:
        stops += light - exposure_value(view)
    return float(2.0**stops)


EFFECT = amplifier(
    "exposure",
    factor,
    settings=(EXPOSURE, LIGHT_VALUE),
    answers=("exposure", "aperture", "shutter", "clipping"),
)
