"""What can be set on a camera: a key of ``[camera]``, how it is read, what it may be.

An effect brings its own settings. Every identity is absent, not multiplied by one: what is not
given costs nothing and changes nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from difflib import get_close_matches
from typing import Any, Generic, TypeVar

import msgspec

from quizgen.camera.setup.values import Reader

T = TypeVar("T")
Judged_contra = TypeVar("Judged_contra", contravariant=True)


class Settings:
    """The values of a camera; what was not given is the identity.

    Parameters
    ----------
    given : mapping of str to object
        Values in base units by the names of their settings.
    """

    def __init__(self, given: Mapping[str, object]) -> None:
        self.given = dict(given)

    def __getitem__(self, setting: Setting[T]) -> T:
        return self.given.get(setting.name, setting.identity)  # type: ignore[return-value]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Settings) and self.given == other.given

    def __hash__(self) -> int:
        return hash(frozenset(self.given.items()))

    def __repr__(self) -> str:
        named = ", ".join(f"{name}={value!r}" for name, value in self.given.items())
        return f"{type(self).__name__}({named})"


class Rule(msgspec.Struct, Generic[Judged_contra], frozen=True):
    """What a value that is not the identity must fulfil, and what is said after its name if not."""

    holds: Callable[[Judged_contra, Settings], bool]
    message: str


class Setting(msgspec.Struct, Generic[T], frozen=True):
    """One key of ``[camera]``.

    Parameters
    ----------
    name : str
        The key.
    read : callable
        From what TOML gives to a value in base units; see `quizgen.camera.setup.values`.
    identity : object
        The value that changes nothing.
    rules : tuple of Rule
        What it may be, also beside the other settings.
    """

    name: str
    read: Reader[T]
    identity: T
    rules: tuple[Rule[T], ...] = ()

    def faults(self, settings: Settings) -> Iterator[str]:
        """Message of every rule that the value breaks, with the setting's name."""
        value = settings[self]
        if value != self.identity:
            broken = (rule for rule in self.rules if not rule.holds(value, settings))
            yield from (f"{self.name} {rule.message}" for rule in broken)


AnySetting = Setting[Any]
"""A setting of any type: tables hold numbers, flags and words side by side."""


def between(low: float, high: float, unit: str = "") -> Rule[float | None]:
    """Rule that a number lies in a range, its ends included."""

    def holds(value: float | None, _: Settings) -> bool:
        return value is None or low <= value <= high

    return Rule(holds, f"must be {low:g} to {high:g} {unit}".rstrip())


def _not_negative(value: float, _: Settings) -> bool:
    return value >= 0.0


NOT_NEGATIVE = Rule(_not_negative, "must be >= 0")
SHARE = between(0.0, 1.0)


def nearest(name: str, known: Iterable[str]) -> str:
    """A hint at the key that was probably meant."""
    close = get_close_matches(name, known, 1)
    return f"; did you mean {close[0]!r}?" if close else ""
