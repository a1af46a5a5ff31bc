"""Settings that several effects share: the lens, the shutter, the size of a photosite."""

from __future__ import annotations

import math

from quizgen.camera.setup.settings import NOT_NEGATIVE, AnySetting, Rule, Setting, Settings, between
from quizgen.camera.setup.values import Reader, number, pair, quantity


def _f_number(value: object) -> float:
    if not isinstance(value, str):
        return number(value)
    try:
        return number(float(value.strip().lower().removeprefix("f/")))
    except ValueError:
        raise ValueError(f"cannot read {value!r}; expected 2.8 or 'f/2.8'") from None


def has_lens(_: object, camera: Settings) -> bool:
    """Whether angles can be turned into pixels."""
    return camera[FOCAL_LENGTH] is not None and camera[PIXEL_PITCH] is not None


def _beyond_focal_length(distance: float, camera: Settings) -> bool:
    return distance > (camera[FOCAL_LENGTH] or 0.0)


def _counts_electrons(_: object, camera: Settings) -> bool:
    return camera[FULL_WELL] is not None


NEEDS_LENS = Rule[object](has_lens, "needs focal_length and pixel_pitch (or sensor_width)")
NEEDS_FULL_WELL = Rule[object](_counts_electrons, "needs full_well")
_FOCUS = Rule(_beyond_focal_length, "must exceed focal_length")


def _maybe(name: str, read: Reader[float], *rules: Rule[float | None]) -> Setting[float | None]:
    return Setting(name, read, None, rules)


FOCAL_LENGTH = _maybe("focal_length", quantity("m"), between(1e-6, 1e3, "m"))
PIXEL_PITCH = _maybe("pixel_pitch", quantity("m"), between(1e-9, 1.0, "m"))
F_NUMBER = _maybe("f_number", _f_number, between(0.01, 1e6), NEEDS_LENS)
"""None is a pinhole without width."""


def _instead_of_a_lens(_: object, camera: Settings) -> bool:
    return camera[F_NUMBER] is None and math.isinf(camera[FOCUS_DISTANCE])


PINHOLE = _maybe(
    "pinhole", quantity("m"), between(1e-6, 1.0, "m"), NEEDS_LENS,
    Rule(_instead_of_a_lens, "stands instead of f_number and focus_distance"),
)  # fmt: skip
"""Diameter of a hole without a lens, m; `FOCAL_LENGTH` is then its distance from the sensor."""
FOCUS_DISTANCE = Setting("focus_distance", quantity("m"), math.inf, (_FOCUS,))
SHUTTER = Setting("shutter", quantity("s"), 0.0, (NOT_NEGATIVE,))
"""Exposure time, s."""
VELOCITY = Setting("velocity", pair(quantity("px/s")), (0.0, 0.0))
"""Movement of the picture over the sensor, px/s."""
FULL_WELL = _maybe("full_well", quantity("e-"), between(1.0, 1e12, "e-"))
"""Electrons at signal 1; None counts no electrons."""

LENS: tuple[Setting[float | None] | Setting[float], ...] = (
    FOCAL_LENGTH, PIXEL_PITCH, F_NUMBER, FOCUS_DISTANCE, PINHOLE,
)  # fmt: skip
BODY: tuple[AnySetting, ...] = (*LENS, SHUTTER, VELOCITY, FULL_WELL)


def aperture(camera: Settings) -> float | None:
    """Diameter of the opening that light comes through, m; None for a point."""
    length, number = camera[FOCAL_LENGTH], camera[F_NUMBER]
    return camera[PINHOLE] if number is None or length is None else length / number
