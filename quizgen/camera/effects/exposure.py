"""Exposure: light by aperture and shutter, and a correction of 2^stops."""

from __future__ import annotations

import math

from quizgen.camera.effects.gain import make_gain_effect
from quizgen.camera.setup.settings import (
    SHUTTER,
    Setting,
    SettingRule,
    aperture_diameter,
    in_range,
)
from quizgen.camera.setup.value_parsers import parse_plain_number, quantity_parser
from quizgen.camera.setup.view import View

EXPOSURE = Setting("exposure", quantity_parser("stop"), 0.0, (in_range(-40.0, 40.0, "stop"),))
"""Correction in stops; +1 doubles."""


_LETS_LIGHT_IN = SettingRule[object](
    lambda _, camera: aperture_diameter(camera) is not None and camera[SHUTTER] > 0.0,
    "needs shutter, and f_number or pinhole",
)
LIGHT_VALUE = Setting[float | None](
    "light_value", parse_plain_number, None, (in_range(-20.0, 30.0), _LETS_LIGHT_IN)
)
"""Brightness of the scene: the exposure value for ISO 100 that makes radiance 1 white."""


def exposure_factor(view: View) -> float:
    """Return what radiance is multiplied by on its way to the photosites.

    `quizgen.camera.effects.gain` follows later. Without a light value the picture is metered:
    f-number and shutter do not change it.
    """
    stops, light = view.camera[EXPOSURE], view.camera[LIGHT_VALUE]
    if light is not None:
        # the exposure value log2(N^2/t), as on a light meter set to ISO 100 (ISO 2720)
        stops += light - math.log2(view.f_number**2 / view.camera[SHUTTER])
    return float(2.0**stops)


EFFECT = make_gain_effect(
    "exposure", exposure_factor, (EXPOSURE, LIGHT_VALUE),
    "exposure", "aperture", "shutter", "clipping",
)  # fmt: skip
