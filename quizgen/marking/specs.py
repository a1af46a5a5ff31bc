"""What all answer specs share: their common fields, and reading them from plain tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

import msgspec

from quizgen.errors import FormulaError, KeyFileError
from quizgen.marking.diagnosis.slips import CLOSE
from quizgen.marking.reading.scalars import Number
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.values import Value

Notes = dict[str, dict[str, str]]
"""Language to sentences by trap name."""


class Spec(msgspec.Struct, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """Fields of every kind.

    ``traps`` maps a trap's name to the wrong answer it gives (same shape and unit as the key),
    ``notes`` maps a language to sentences by trap name, ``of`` names the chain's quantities that
    the answer consists of.
    """

    kind: str
    traps: dict[str, Any] = msgspec.field(default_factory=dict)
    notes: Notes = msgspec.field(default_factory=dict)
    of: list[str] | dict[str, str] = msgspec.field(default_factory=list)

    def quantities(self) -> list[str]:
        """Names of the chain's quantities, in the order of the values."""
        return _names(self.of)

    def validate(self) -> None:
        """Check what types cannot say.

        Raises
        ------
        FormulaError
            If a value cannot be read.
        ValueError
            If fields contradict each other.
        """


class Measured(Tolerance, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """Fields of every kind whose key is made of numbers: those of ``Spec``, and the tolerance."""

    kind: str
    traps: dict[str, Any] = msgspec.field(default_factory=dict)
    notes: Notes = msgspec.field(default_factory=dict)
    of: list[str] | dict[str, str] = msgspec.field(default_factory=list)

    def quantities(self) -> list[str]:
        """Names of the chain's quantities, in the order of the values."""
        return _names(self.of)


AnySpec = Spec | Measured
Shape = TypeVar("Shape", Spec, Measured)


def _names(of: list[str] | dict[str, str]) -> list[str]:
    return list(of.values()) if isinstance(of, dict) else of


def gives(spec: Tolerance, number: Number, value: Value, target: Value) -> bool:
    """Whether a value is the target within the tolerance, or the target rounded as written."""
    if spec.near(value, target):
        return True
    distance = abs(value - target)
    rounded = number.places and distance * 2 * 10**number.places <= 1
    return bool(rounded and distance <= CLOSE * abs(target))


def decode(shape: type[Shape], table: Mapping[str, Any]) -> Shape:
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
