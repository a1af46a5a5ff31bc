"""How near an answer must be to its key: one rule for drawing, marking and the student's hint."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import ClassVar

import msgspec
from flint import fmpq

from quizgen.core.decoding import convert
from quizgen.maths.constants import Scalar, parse_exact
from quizgen.maths.numbers import decimal_exponent, to_float
from quizgen.maths.values import Value

MOST_DIGITS = 40
"""Most decimals or significant figures that can be asked."""

RULES = ("decimals", "sigfigs", "rel", "abs", "exact")
"""The ways to state a tolerance; a part gives at most one of them."""

MARGIN = 1 + 1e-9
"""Factor by which a width computed from a float is widened, so that it is never too small."""

ROUNDED, ROUNDED_REL = 0.005, 0.01
"""Half-width and share of the key within which an exact answer may still be meant: two decimals."""


class Tolerance(msgspec.Struct, kw_only=True, frozen=True, omit_defaults=True,
                forbid_unknown_fields=True):  # fmt: skip
    """How near an answer must be: at most one rule, else half a percent of the key.

    ``decimals`` and ``sigfigs`` accept ``within`` units (default one) in the last place asked;
    all bounds are closed. ``accept`` is an interval that is accepted as well. ``strict`` asks for
    exactly the precision stated.
    """

    decimals: int | None = None
    sigfigs: int | None = None
    rel: Scalar | None = None
    abs: Scalar | None = None
    exact: bool = False
    within: Scalar = 1
    accept: list[Scalar] | None = None
    strict: bool = False

    unstated: ClassVar[tuple[str, Scalar]] = ("rel", "1/200")
    """The rule that holds where none is stated."""

    def validate(self) -> None:
        """Check what types cannot express.

        Raises
        ------
        FormulaError
            If a number cannot be read.
        ValueError
            If two rules are given, or one is out of range.
        """
        if self.stated_values().count(None) < len(RULES) - 1:
            raise ValueError("only one of decimals, sigfigs, rel, abs, exact can be given")
        if self.accept is not None and len(self.accept) != 2:
            raise ValueError("accept needs two bounds")
        if not 0 <= (self.decimals or 0) <= MOST_DIGITS:
            raise ValueError(f"decimals must be 0 to {MOST_DIGITS}")
        if self.sigfigs is not None and not 1 <= self.sigfigs <= MOST_DIGITS:
            raise ValueError(f"sigfigs must be 1 to {MOST_DIGITS}")
        for bound in self.accept or ():
            parse_exact(bound)
        for name, width in (("rel", self.rel), ("abs", self.abs), ("within", self.within)):
            if width is not None and parse_exact(width) < 0:
                raise ValueError(f"{name} must not be negative")

    def stated_values(self) -> tuple[Scalar | None, ...]:
        """Return what was given for each rule, in the order of ``RULES``."""
        return (self.decimals, self.sigfigs, self.rel, self.abs, self.exact or None)

    @property
    def stated_rule(self) -> tuple[str, Scalar] | None:
        """The rule that was given, as its name and its number; None if none was."""
        for name, number in zip(RULES, self.stated_values(), strict=True):
            if number is not None:
                return name, number
        return None

    def half_width(self, key: Value) -> Value:
        """Return the largest accepted distance from a key, exactly."""
        if self.decimals is not None:
            return parse_exact(self.within) * _compute_place_value(self.decimals)
        if self.sigfigs is not None:
            return parse_exact(self.within) * _compute_place_value(
                self.sigfigs - 1 - decimal_exponent(key)
            )
        if self.exact:
            return fmpq(0)
        if self.rel is not None:
            return parse_exact(self.rel) * abs(key)
        if self.abs is not None:
            return parse_exact(self.abs)
        name, number = self.unstated
        return parse_exact(number) * abs(key) if name == "rel" else parse_exact(number)

    def outer_width(self, key: float) -> float:
        """Return the half-width around an approximate key, never too small.

        An exact answer counts as meant while it could be a rounded way to write the key.
        """
        if self.exact:
            return min(ROUNDED, ROUNDED_REL * abs(key))
        name, number = self.stated_rule or self.unstated
        if name == "rel":
            return to_float(parse_exact(number)) * abs(key) * MARGIN
        beyond = fmpq(*(abs(key) * MARGIN).as_integer_ratio())
        return to_float(self.half_width(beyond)) * MARGIN

    def is_within(self, value: Value, key: Value) -> bool:
        """Return whether a value lies within the tolerance of a key (closed, decided exactly).

        A ball that cannot be told from the bound counts as on it.
        """
        width, distance = self.half_width(key), abs(value - key)
        if isinstance(distance, fmpq) and isinstance(width, fmpq):
            return bool(distance <= width)
        return not distance > width

    def accepts(self, value: Value, key: Value) -> bool:
        """Return whether a value is near the key, or in the interval that is accepted as well."""
        if self.accept is None or self.is_within(value, key):
            return self.is_within(value, key)
        low, high = map(parse_exact, self.accept)
        return bool(low <= value <= high)


@lru_cache(maxsize=1024)
def _compute_place_value(decimals: int) -> fmpq:
    """Return what a one is worth in a decimal place: 1/100 for 2."""
    return fmpq(10) ** -decimals


class AngleTolerance(Tolerance, kw_only=True, frozen=True):
    """Tolerance of an angle in degrees: half a degree unless a rule is stated."""

    unstated: ClassVar[tuple[str, Scalar]] = ("abs", "0.5")


def parse_tolerance(answer: Mapping[str, object]) -> Tolerance:
    """Return the tolerance that an authored answer states.

    Parameters
    ----------
    answer : mapping
        ``kind`` and the rule stand among other keys. ``accept`` is left out: its bounds may be
        formulas over drawn quantities.

    Raises
    ------
    msgspec.ValidationError, ValueError
        If the rule is wrong.
    """
    shape = AngleTolerance if answer.get("kind") == "angle" else Tolerance
    names = {*shape.__struct_fields__} - {"accept"}
    found = convert({n: answer[n] for n in names & answer.keys()}, shape)
    found.validate()
    return found
