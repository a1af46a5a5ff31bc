"""What all answer specs share: reading them from plain tables, tolerances, traps."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import msgspec
from flint import fmpq

from quizgen.errors import FormulaError, KeyFileError
from quizgen.marking.diagnosis.slips import CLOSE
from quizgen.marking.reading.scalars import Number, exact_value
from quizgen.marking.rounding import magnitude

Scalar = str | int | float
"""An exact number in a spec: ``"20/3"``, ``"6.67"``, ``12`` or a constant formula."""

MOST_DIGITS = 40
"""Most decimals or significant figures that can be asked."""

DEFAULT_REL = fmpq(1, 200)
"""Tolerance when a spec states none: half a percent of the key."""


class Spec(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Fields of every kind.

    ``traps`` maps a trap's name to the wrong answer it gives (same shape and unit as the key),
    ``notes`` maps a language to sentences by trap name, ``of`` names the chain's quantities that
    the answer consists of.
    """

    kind: str
    traps: dict[str, Any] = {}
    notes: dict[str, dict[str, str]] = {}
    of: list[str] | dict[str, str] = []

    longest: ClassVar[int] = 200

    def quantities(self) -> list[str]:
        """Names of the chain's quantities, in the order of the values."""
        return list(self.of.values()) if isinstance(self.of, dict) else self.of

    def validate(self) -> None:
        """Check what types cannot say.

        Raises
        ------
        FormulaError
            If a value cannot be read.
        ValueError
            If fields contradict each other.
        """


class Tolerance(Spec, kw_only=True):
    """How near an answer must be: at most one of the five, else half a percent of the key.

    ``decimals`` and ``sigfigs`` accept ``within`` units (default one) in the last place asked;
    all bounds are closed. ``strict`` asks for exactly that precision.
    """

    decimals: int | None = None
    sigfigs: int | None = None
    rel: Scalar | None = None
    abs: Scalar | None = None
    exact: bool = False
    within: Scalar = 1
    accept: list[Scalar] | None = None
    strict: bool = False

    def validate(self) -> None:
        """Refuse two tolerances at once and unreadable numbers."""
        stated = [self.decimals, self.sigfigs, self.rel, self.abs, self.exact or None]
        if sum(item is not None for item in stated) > 1:
            raise ValueError("only one of decimals, sigfigs, rel, abs, exact can be given")
        if self.accept is not None and len(self.accept) != 2:
            raise ValueError("accept needs two bounds")
        if not 0 <= (self.decimals or 0) <= MOST_DIGITS:
            raise ValueError(f"decimals must be 0 to {MOST_DIGITS}")
        if not 1 <= (self.sigfigs or 1) <= MOST_DIGITS:
            raise ValueError(f"sigfigs must be 1 to {MOST_DIGITS}")
        for value in (self.rel, self.abs, self.within, *(self.accept or ())):
            if value is not None:
                exact_value(value)


def half_width(spec: Tolerance, key: Any) -> Any:
    """Return the largest accepted distance from the key, exactly."""
    if spec.decimals is not None:
        return exact_value(spec.within) / 10**spec.decimals
    if spec.rel is not None:
        return exact_value(spec.rel) * abs(key)
    if spec.abs is not None:
        return exact_value(spec.abs)
    if spec.exact:
        return fmpq(0)
    if spec.sigfigs is not None:
        return exact_value(spec.within) * fmpq(10) ** (magnitude(key) + 1 - spec.sigfigs)
    return DEFAULT_REL * abs(key)


def near(spec: Tolerance, value: Any, key: Any) -> bool:
    """Whether a value lies within the tolerance of a key (closed, decided exactly).

    A ball that cannot be told from the bound counts as on it.
    """
    width = half_width(spec, key)
    distance = abs(value - key)
    if isinstance(distance, fmpq) and isinstance(width, fmpq):
        return bool(distance <= width)
    return not distance > width


def accepted(spec: Tolerance, value: Any, key: Any) -> bool:
    """``near``, or inside the interval accepted besides."""
    if near(spec, value, key):
        return True
    if spec.accept is None:
        return False
    low, high = map(exact_value, spec.accept)
    return bool(low <= value <= high)


def gives(spec: Tolerance, number: Number, value: Any, target: Any) -> bool:
    """Whether a value is the target within the tolerance, or the target rounded as written."""
    if near(spec, value, target):
        return True
    distance = abs(value - target)
    rounded = number.places and distance * 2 * 10**number.places <= 1
    return bool(rounded and distance <= CLOSE * abs(target))


def decode(shape: type[Spec], table: Mapping[str, Any]) -> Spec:
    """Turn a plain table into the spec of its kind.

    Raises
    ------
    KeyFileError
        Naming the field that is wrong.
    """
    try:
        spec = msgspec.convert(table, shape)
        spec.validate()
    except (msgspec.ValidationError, FormulaError, ValueError, TypeError) as error:
        raise KeyFileError(f"spec ({table['kind']}): {error}") from None
    return spec
