"""Settings that several effects share: the lens, the shutter, the size of a photosite."""

from __future__ import annotations

import math

from quizgen.camera.settings import NOT_NEGATIVE, AnySetting, Rule, Setting, Settings
from quizgen.camera.values import Reader, number, pair, quantity


def _f_number(value: object) -> float:
    text = value.removeprefix("f/") if isinstance(value, str) else value
    return number(float(text) if isinstance(text, str) else text)


def _positive(value: float | None, _: Settings) -> bool:
    return value is None or 0 < value < math.inf


def has_lens(_: object, camera: Settings) -> bool:
    """Whether angles can be turned into pixels."""
    return camera[FOCAL_LENGTH] is not None and camera[PIXEL_PITCH] is not None


def _beyond_focal_length(distance: float, camera: Settings) -> bool:
    return distance > (camera[FOCAL_LENGTH] or 0.0)


def _counts_electrons(_: object, camera: Settings) -> bool:
    return camera[FULL_WELL] is not None


POSITIVE = Rule(
    _positive, "focal_length, pixel_pitch, f_number and full_well must be positive and finite"
)
NEEDS_LENS = Rule[object](has_lens, "the lens needs focal_length and pixel_pitch")
NEEDS_FULL_WELL = Rule[object](
    _counts_electrons, "read noise, dark current, hot pixels, blooming and smear need full_well"
)
_FOCUS = Rule(_beyond_focal_length, "focus_distance must exceed focal_length")


def _maybe(name: str, read: Reader[float], *rules: Rule[object]) -> Setting[float | None]:
    return Setting(name, read, None, (POSITIVE, *rules))


FOCAL_LENGTH = _maybe("focal_length", quantity("m"))
PIXEL_PITCH = _maybe("pixel_pitch", quantity("m"))
F_NUMBER = _maybe("f_number", _f_number, NEEDS_LENS)
"""None is a pinhole."""
FOCUS_DISTANCE = Setting("focus_distance", quantity("m"), math.inf, (_FOCUS,))
SHUTTER = Setting("shutter", quantity("s"), 0.0, (NOT_NEGATIVE,))
"""Exposure time, s."""
VELOCITY = Setting("velocity", pair(quantity("px/s")), (0.0, 0.0))
"""Movement of the picture over the sensor, px/s."""
FULL_WELL = _maybe("full_well", quantity("e-"))
"""Electrons at signal 1; None counts no electrons."""

LENS: tuple[Setting[float | None] | Setting[float], ...] = (
    FOCAL_LENGTH, PIXEL_PITCH, F_NUMBER, FOCUS_DISTANCE,
)  # fmt: skip
BODY: tuple[AnySetting, ...] = (*LENS, SHUTTER, VELOCITY, FULL_WELL)
