"""What can be set on a camera: a key of ``[camera]``, how it is read, what it may be.

An effect brings its own settings. Every identity is absent, not multiplied by one: what is not
given costs nothing and changes nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from difflib import get_close_matches
from typing import Any, Generic, TypeVar

import msgspec

from quizgen.camera.setup.value_parsers import (
    ValueParser,
    pair_parser,
    parse_plain_number,
    quantity_parser,
)

T = TypeVar("T")
Judged_contra = TypeVar("Judged_contra", contravariant=True)


class CameraSettings:
    """The settings of a camera; one that was not given has the value that changes nothing.

    Parameters
    ----------
    given : mapping of str to object
        Values in base units by the names of their settings.
    """

    def __init__(self, given: Mapping[str, object]) -> None:
        self.given = dict(given)

    def __getitem__(self, setting: Setting[T]) -> T:
        """Return the value of a setting: what was given, else its identity."""
        return self.given.get(setting.name, setting.identity)  # type: ignore[return-value]

    def __eq__(self, other: object) -> bool:
        """Return whether the same settings were given."""
        return isinstance(other, CameraSettings) and self.given == other.given

    def __hash__(self) -> int:
        """Return a hash of what was given."""
        return hash(frozenset(self.given.items()))

    def __repr__(self) -> str:
        """Return the settings as they were given."""
        named = ", ".join(f"{name}={value!r}" for name, value in self.given.items())
        return f"{type(self).__name__}({named})"


class SettingRule(msgspec.Struct, Generic[Judged_contra], frozen=True):
    """A condition on a value that is not the identity, and the message if it is broken."""

    holds: Callable[[Judged_contra, CameraSettings], bool]
    message: str


class Setting(msgspec.Struct, Generic[T], frozen=True):
    """One setting of the camera, a key of ``[camera]``.

    Parameters
    ----------
    name : str
        The key.
    read : callable
        From what TOML gives to a value in base units; see `quizgen.camera.setup.value_parsers`.
    identity : object
        The value that changes nothing.
    rules : tuple of SettingRule
        What it may be, alone and together with other settings.
    """

    name: str
    read: ValueParser[T]
    identity: T
    rules: tuple[SettingRule[T], ...] = ()

    def find_faults(self, settings: CameraSettings) -> Iterator[str]:
        """Yield the message of every rule that the value breaks, with the setting's name."""
        value = settings[self]
        if value != self.identity:
            broken = (rule for rule in self.rules if not rule.holds(value, settings))
            yield from (f"{self.name} {rule.message}" for rule in broken)


AnySetting = Setting[Any]
"""A setting of any type: tables hold numbers, flags and words side by side."""


def in_range(low: float, high: float, unit: str = "") -> SettingRule[float | None]:
    """Return the rule that a number lies in a range, ends included; ``unit`` is for the message."""

    def holds(value: float | None, _: CameraSettings) -> bool:
        """Return whether the value is absent or in the range."""
        return value is None or low <= value <= high

    return SettingRule(holds, f"must be {low:g} to {high:g} {unit}".rstrip())


NOT_NEGATIVE = SettingRule[float](lambda value, _: value >= 0.0, "must be >= 0")
SHARE = in_range(0.0, 1.0)


def suggest_setting(name: str, known: Iterable[str]) -> str:
    """Return the end of a message: the known key closest to a misspelt one, or ""."""
    close = get_close_matches(name, known, 1)
    return f"; did you mean {close[0]!r}?" if close else ""


# Settings that several effects share: the lens, the shutter, the size of a photosite


def _parse_f_number(value: object) -> float:
    """Return an f-number from a number or a text such as ``f/8``."""
    if not isinstance(value, str):
        return parse_plain_number(value)
    try:
        return parse_plain_number(float(value.strip().lower().removeprefix("f/")))
    except ValueError:
        raise ValueError(f"cannot read {value!r}; expected 2.8 or 'f/2.8'") from None


def _optional_setting(
    name: str, read: ValueParser[float], *rules: SettingRule[float | None]
) -> Setting[float | None]:
    """Return a setting that is None unless it is given."""
    return Setting(name, read, None, rules)


FOCAL_LENGTH = _optional_setting("focal_length", quantity_parser("m"), in_range(1e-6, 1e3, "m"))
PIXEL_PITCH = _optional_setting("pixel_pitch", quantity_parser("m"), in_range(1e-9, 1.0, "m"))
FULL_WELL = _optional_setting("full_well", quantity_parser("e-"), in_range(1.0, 1e12, "e-"))
"""Electrons at signal 1; None counts no electrons."""
NEEDS_LENS = SettingRule[object](
    lambda _, camera: camera[FOCAL_LENGTH] is not None and camera[PIXEL_PITCH] is not None,
    "needs focal_length and pixel_pitch (or sensor_width)",
)
NEEDS_FULL_WELL = SettingRule[object](
    lambda _, camera: camera[FULL_WELL] is not None, "needs full_well"
)
F_NUMBER = _optional_setting("f_number", _parse_f_number, in_range(0.01, 1e6), NEEDS_LENS)
"""None is a pinhole without width."""
_FOCUS = SettingRule[float](
    lambda distance, camera: distance > (camera[FOCAL_LENGTH] or 0.0), "must exceed focal_length"
)
FOCUS_DISTANCE = Setting("focus_distance", quantity_parser("m"), math.inf, (_FOCUS,))
_NO_LENS = SettingRule[object](
    lambda _, camera: camera[F_NUMBER] is None and math.isinf(camera[FOCUS_DISTANCE]),
    "stands instead of f_number and focus_distance",
)
PINHOLE = _optional_setting(
    "pinhole", quantity_parser("m"), in_range(1e-6, 1.0, "m"), NEEDS_LENS, _NO_LENS
)
"""Diameter of a hole without a lens, m; `FOCAL_LENGTH` is then its distance from the sensor."""
SHUTTER = Setting("shutter", quantity_parser("s"), 0.0, (NOT_NEGATIVE,))
"""Exposure time, s."""
VELOCITY = Setting("velocity", pair_parser(quantity_parser("px/s")), (0.0, 0.0))
"""Movement of the picture over the sensor, px/s."""

BODY: tuple[AnySetting, ...] = (
    FOCAL_LENGTH, PIXEL_PITCH, F_NUMBER, FOCUS_DISTANCE, PINHOLE, SHUTTER, VELOCITY, FULL_WELL,
)  # fmt: skip


def aperture_diameter(camera: CameraSettings) -> float | None:
    """Return the diameter of the camera's opening, m; None for a point."""
    length, number = camera[FOCAL_LENGTH], camera[F_NUMBER]
    return camera[PINHOLE] if number is None or length is None else length / number
