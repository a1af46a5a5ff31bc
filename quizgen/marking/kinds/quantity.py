"""Kind ``quantity``: a number with a unit; compared in base units, judged in the key's unit."""

from __future__ import annotations

from fractions import Fraction

from flint import fmpq

from quizgen.marking.diagnosis.context import hints_for
from quizgen.marking.diagnosis.slips import close, power_of_ten, radians
from quizgen.marking.judging.number import Asked, best, judge_value, resolve
from quizgen.marking.options import Options
from quizgen.marking.reading.chains import Side, plain_side, read_sides
from quizgen.marking.reading.named import without_name
from quizgen.marking.reading.quantities import TypedQuantity
from quizgen.marking.reading.rewrites import normalise
from quizgen.marking.reading.scalars import Number
from quizgen.marking.reading.unit_words import TypedUnit, plain_unit
from quizgen.marking.rounding import shown
from quizgen.marking.specs import OneNumber
from quizgen.marking.verdict import HALF, Verdict, partial, with_values, wrong
from quizgen.maths.constants import exact_value
from quizgen.maths.notation import people
from quizgen.maths.units import shown as shown_unit
from quizgen.maths.values import Value

DEGREES = (("deg", 1),)
POWERS = frozenset({"power-of-ten", "percent-slip"})
"""Slips of a number that are those of a prefix where the number has a unit."""


class Spec(OneNumber, kw_only=True, frozen=True):
    """Quantity: ``value`` in ``unit``; with ``bare`` the unit is printed beside the field."""

    unit: str
    bare: bool = False

    def validate(self) -> None:
        """Check tolerance, value, unit and traps."""
        super().validate()
        plain_unit(self.unit)

    def value_unit(self) -> str:
        """The unit of the key."""
        return self.unit

    def judge(self, typed: str, options: Options, /) -> Verdict:
        """Judge a typed quantity."""
        plain = plain_side(typed, options.decimal)
        if plain is not None:
            return _resolved(self, plain, options)
        sides = read_sides(without_name(normalise(typed)), options.decimal)
        return best(_resolved(self, side, options) for side in sides)

    def show(self) -> str:
        """Return the key as printed and as it can be typed back."""
        number = people.number(shown(self, exact_value(self.value)))
        return f"{number} {shown_unit(self.unit)}".strip()


def _resolved(spec: Spec, side: Side, options: Options) -> Verdict:
    return resolve(side.readings, lambda n: _judge(spec, n, side.quantity, options), spec.decimals)


def _judge(spec: Spec, number: Number, quantity: TypedQuantity, options: Options) -> Verdict:
    wanted = plain_unit(spec.unit)
    if quantity.unit is None:
        return _without_unit(spec, number, wanted, options)
    read_as = f"{number.read_as} {shown_unit(quantity.unit.text)}"
    if quantity.unit.dimension != wanted.dimension:
        return _clash(spec, number, quantity.unit, read_as)
    value = number.value * quantity.unit.factor / wanted.factor
    verdict = judge_unit(spec, number, value, options, read_as)
    return _prefix(spec, number, value, quantity.unit, verdict)


def judge_unit(spec: Spec, number: Number, value: Value, options: Options, read_as: str) -> Verdict:
    """Judge a value that stands in the key's unit."""
    asked = Asked(
        spec,
        exact_value(spec.value),
        spec.trap_values(),
        hints=hints_for(spec, number, fmpq(1), options),
    )
    verdict = judge_value(asked, number, value, read_as)
    return with_values(verdict, value)


def _without_unit(spec: Spec, number: Number, wanted: TypedUnit, options: Options) -> Verdict:
    verdict = judge_unit(spec, number, number.value, options, number.read_as)
    if spec.unit == "%" and not verdict.credit:
        fraction = judge_unit(spec, number, number.value * 100, options, number.read_as)
        verdict = fraction if fraction.credit else verdict
    if not wanted.dimension and wanted.factor == 1:
        return verdict
    if spec.bare:
        return _prefix(spec, number, number.value, wanted, verdict)
    if verdict.credit:
        return _missing(spec, number, verdict, options.points)
    ratio = _logarithm(spec, number.value, number.read_as)
    return ratio or _prefix(spec, number, number.value, wanted, verdict)


def _missing(spec: Spec, number: Number, verdict: Verdict, points: Fraction) -> Verdict:
    """Take off for the unit: half, but never more than half a point, and nothing besides."""
    credit = max(HALF, 1 - HALF / points)
    if verdict.credit < credit:
        return verdict
    unit = shown_unit(spec.unit)
    return with_values(partial(credit, number.read_as, "unit-missing", unit=unit), number.value)


def _clash(spec: Spec, number: Number, typed: TypedUnit, read_as: str) -> Verdict:
    note = "unit-clash"
    if close(number.value, exact_value(spec.value)):
        note = "unit-wrong"
    asked = shown_unit(spec.unit)
    return with_values(wrong(read_as, note, given=shown_unit(typed.text), asked=asked), None)


def _prefix(
    spec: Spec, number: Number, value: Value, typed: TypedUnit, verdict: Verdict
) -> Verdict:
    """Name a wrong power of ten as a slip of the prefix."""
    key = exact_value(spec.value)
    if verdict.note == "factor" and spec.unit == "dB":
        return _decibel(value, key, verdict)
    if verdict.credit or verdict.note.startswith("trap:"):
        return verdict
    if typed.dimension == DEGREES and typed.factor == 1 and radians(number.value, key):
        return with_values(wrong(verdict.read_as, "radians"), *verdict.values)
    same = close(number.value, key) and typed.text != spec.unit
    power = power_of_ten(value, key)
    if not (same and power) and verdict.note not in POWERS:
        return verdict
    if abs(power) == 1 and not any(base == "m" for base, _ in typed.dimension):
        return verdict  # ten times is a prefix of lengths only: cm and mm
    asked = shown_unit(spec.unit)
    note = "unit-prefix" if same else "unit-prefix-power"
    fields = {"asked": asked, "power": power}
    return with_values(wrong(verdict.read_as, note, **fields), *verdict.values)


def _decibel(value: Value, key: Value, verdict: Verdict) -> Verdict:
    if close(value * 2, key):
        return with_values(wrong(verdict.read_as, "decibel-ten"), *verdict.values)
    if close(value, key * 2):
        return with_values(wrong(verdict.read_as, "decibel-twenty"), *verdict.values)
    return verdict


def _logarithm(spec: Spec, value: Value, read_as: str) -> Verdict | None:
    """Report a ratio given where decibels were asked."""
    if spec.unit != "dB" or not value > 0:
        return None
    key = float(exact_value(spec.value))
    for per_decade in (10, 20):
        if abs(float(value) - 10 ** (key / per_decade)) <= 0.005 * float(value):
            return wrong(read_as, "ratio-for-decibel")
    return None
