"""Kind ``quantity``: a number with a unit; compared in base units, judged in the key's unit."""

from __future__ import annotations

import re
from collections.abc import Iterable
from fractions import Fraction
from typing import ClassVar

from flint import fmpq
from msgspec.structs import replace

from quizgen.grading.diagnosis.carry_forward import diagnosis_for
from quizgen.grading.diagnosis.numeric_slips import (
    agrees_within_half_percent,
    is_in_radians,
    power_of_ten_off,
)
from quizgen.grading.judging.numeric import NumberTarget, best_verdict, judge_readings, judge_value
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.angle_spellings import list_angle_spellings
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.equalities import EqualitySide, read_typed_sides
from quizgen.grading.reading.numbers import ReadNumber
from quizgen.grading.reading.quantities import TypedQuantity, put_unit_behind
from quizgen.grading.reading.units import TypedUnit, listed_unit, part_joined_units
from quizgen.grading.rounding import format_key
from quizgen.grading.spec import COUNTED, ScalarSpec, is_large_count
from quizgen.grading.verdict import HALF, Verdict, attach_values, partial, wrong
from quizgen.kinds.asking import (
    accept_within_tolerance,
    ask_numeric,
    numeric_hints,
    precision_on_paper,
    show_exact_first,
)
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    AuthoredNumeric,
    PartContext,
    asked_quantities,
)
from quizgen.locale import translate
from quizgen.maths.constants import parse_exact
from quizgen.maths.notation import FormulaReadError, pretty
from quizgen.maths.numbers import SECONDS, format_duration
from quizgen.maths.units import Dimension, format_unit
from quizgen.maths.values import Value

DEGREES = (("deg", 1),)
POWERS = frozenset({"power-of-ten", "percent-slip"})
"""Slips of a number that are those of a prefix where the number has a unit."""


class AuthoredQuantity(AuthoredNumeric, tag="quantity", frozen=True):
    """A number with its unit."""

    unit: str = ""
    bare: bool = False


class QuantitySpec(ScalarSpec, kw_only=True, frozen=True):
    """Quantity: ``value`` in ``unit``; with ``bare`` the unit is printed beside the field."""

    written_as: ClassVar[AnswerForm] = "quantity"

    unit: str
    bare: bool = False

    def validate(self) -> None:
        """Check tolerance, value, unit and traps; errors as ``WordSpec.validate``."""
        super().validate()
        listed_unit(self.unit)

    @property
    def is_whole(self) -> bool:
        """Whether a whole number of bytes, bits or pixels is asked."""
        return self.unit in COUNTED and is_large_count(parse_exact(self.value))

    def value_unit(self) -> str:
        """Return the unit of the key."""
        return self.unit

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on a typed quantity; of equal ones that were chained the best.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """
        clock = _CLOCK.fullmatch(typed.strip())
        if clock and listed_unit(self.unit).dimension == listed_unit(SECONDS).dimension:
            return self._judge_clock(clock, options)
        return self._judge_plain(typed, options)

    def _judge_clock(self, clock: re.Match[str], options: GradingOptions) -> Verdict:
        """Return the verdict on ``19:17`` as hours and minutes, or minutes and seconds, or a share.

        Raises
        ------
        FormulaReadError
            If it is right in none of these ways.
        """
        first, second, third = int(clock[1]), int(clock[2]), int(clock[3] or 0)
        for seconds in (3600 * first + 60 * second + third, 60 * first + second):
            verdict = self._judge_plain(f"{seconds} {SECONDS}", options)
            if verdict.credit:
                return replace(verdict, read_as=clock[0])
        verdict = self._judge_plain(clock[0], options)
        if verdict.credit:
            return verdict
        raise FormulaReadError("two-readings", 1, clock[0])

    def _judge_plain(self, typed: str, options: GradingOptions) -> Verdict:
        """Return the verdict on a number with a unit, or on equal ones that were chained.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """
        typed = put_unit_behind(part_joined_units(typed, self.unit), self.unit)
        found: list[Verdict] = []
        for text in self._list_spellings(typed):
            try:
                sides = read_typed_sides(text, options.decimal)
            except FormulaReadError as error:
                if error.expected and error.found.lower() == self.unit.lower():
                    error.expected = (self.unit,)  # ev is eV where that is asked, not EV
                refused = error
                continue
            found.append(best_verdict(_judge_side(self, side, options) for side in sides))
        if not found:
            raise refused
        return max(found, key=lambda verdict: verdict.credit)

    def _list_spellings(self, typed: str) -> Iterable[str]:
        """Return the answer as typed, and in the other ways that degrees are meant."""
        if self.unit not in {"deg", "°"}:
            return (typed,)
        return [typed, *(_with_degrees(text) for text in list_angle_spellings(typed))]

    @property
    def printed_unit(self) -> str:
        """The unit that is printed beside the field on paper."""
        return self.unit

    def show(self) -> str:
        """Return the key as printed and as it can be typed back: short times as cameras do."""
        value = parse_exact(self.value)
        if self.unit == SECONDS and self.decimals is None and (time := format_duration(value)):
            return f"{time} {SECONDS}"
        number = pretty.format_number(format_key(self, value))
        return f"{number} {format_unit(self.unit)}".strip()


def _with_degrees(text: str) -> str:
    """Return a formula of degrees with their sign behind it, which functions do without."""
    if "180/pi" not in text:
        return text
    return f"{text}°" if "=" in text or text.endswith(")") else f"({text})°"


_CLOCK = re.compile(
    r"(?:[^\W\d_]\w* ?[=:≈] ?)?(\d+):([0-5]\d)(?::([0-5]\d))?(?: ?(?:h|min|m|s|Uhr))?"
)
"""A time as clocks show it."""


def _judge_side(spec: QuantitySpec, side: EqualitySide, options: GradingOptions) -> Verdict:
    """Return the verdict on one side, whose number may have two readings."""
    return judge_readings(
        side.readings,
        lambda n: _judge_reading(spec, n, side.quantity, options),
        spec.decimals,
        whole=spec.is_whole,
    )


def _judge_reading(
    spec: QuantitySpec, number: ReadNumber, quantity: TypedQuantity, options: GradingOptions
) -> Verdict:
    """Return the verdict on one reading of a number, converted to the key's unit."""
    wanted = listed_unit(spec.unit)
    if quantity.unit is None:
        return _judge_without_unit(spec, number, wanted, options)
    read_as = f"{number.read_as} {format_unit(quantity.unit.text)}"
    typed = quantity.unit.dimension
    if _drop_line_pairs(wanted.dimension) != _drop_line_pairs(typed):
        return _reject_unit_clash(spec, number, quantity.unit, read_as)
    value = number.value * quantity.unit.factor / wanted.factor
    verdict = judge_in_unit(spec, number, value, options, read_as)
    return _diagnose_unit_slip(spec, number, value, quantity.unit, verdict)


def judge_in_unit(
    spec: QuantitySpec, number: ReadNumber, value: Value, options: GradingOptions, read_as: str
) -> Verdict:
    """Return the verdict on a value that stands in the key's unit."""
    asked = NumberTarget(
        spec,
        parse_exact(spec.value),
        spec.trap_values(),
        hints=diagnosis_for(spec, number, fmpq(1), options),
    )
    verdict = judge_value(asked, number, value, read_as)
    return attach_values(verdict, value)


def _drop_line_pairs(typed: Dimension) -> Dimension:
    """Return a dimension without line pairs: 95 lp/mm are 95 periods in a millimetre, 95/mm."""
    return tuple((base, power) for base, power in typed if base != "lp")


def _judge_without_unit(
    spec: QuantitySpec, number: ReadNumber, wanted: TypedUnit, options: GradingOptions
) -> Verdict:
    """Return the verdict on a number that was typed without a unit.

    Nothing is taken off where no unit is needed or it stands printed; a fraction may mean %.
    """
    verdict = judge_in_unit(spec, number, number.value, options, number.read_as)
    if spec.unit == "%" and not verdict.credit:
        fraction = judge_in_unit(spec, number, number.value * 100, options, number.read_as)
        if fraction.credit:
            return fraction  # 0.571 is the share itself, and needs no sign
    if not wanted.dimension and wanted.factor == 1:
        return verdict
    if spec.bare:
        return _diagnose_unit_slip(spec, number, number.value, wanted, verdict)
    if verdict.credit:
        return _deduct_missing_unit(spec, number, verdict, options.points or Fraction(1))
    ratio = _diagnose_ratio_for_decibel(spec, number.value, number.read_as)
    return ratio or _diagnose_unit_slip(spec, number, number.value, wanted, verdict)


def _deduct_missing_unit(
    spec: QuantitySpec, number: ReadNumber, verdict: Verdict, points: Fraction
) -> Verdict:
    """Return the verdict with less credit: half, but never more than half a point.

    A verdict that already has less is returned as it is.
    """
    credit = max(HALF, 1 - HALF / points)
    if verdict.credit < credit:
        return verdict
    unit = format_unit(spec.unit)
    return attach_values(partial(credit, number.read_as, "unit-missing", unit=unit), number.value)


def _reject_unit_clash(
    spec: QuantitySpec, number: ReadNumber, typed: TypedUnit, read_as: str
) -> Verdict:
    """Return the wrong verdict on a unit of another dimension.

    Its note differs where the number is right.
    """
    note = "unit-clash"
    if agrees_within_half_percent(number.value, parse_exact(spec.value)):
        note = "unit-wrong"
    asked = format_unit(spec.unit)
    return attach_values(wrong(read_as, note, given=format_unit(typed.text), asked=asked), None)


def _diagnose_unit_slip(
    spec: QuantitySpec, number: ReadNumber, value: Value, typed: TypedUnit, verdict: Verdict
) -> Verdict:
    """Return the verdict with a slip of the unit, if one explains it, else as it is.

    Such slips are a wrong prefix, radians for degrees, and 10 for 20 in decibels.
    """
    key = parse_exact(spec.value)
    if verdict.note == "factor" and spec.unit == "dB":
        return _diagnose_decibel_factor(value, key, verdict)
    if verdict.credit or verdict.note.startswith("trap:"):
        return verdict
    if typed.dimension == DEGREES and typed.factor == 1 and is_in_radians(number.value, key):
        return attach_values(wrong(verdict.read_as, "radians"), *verdict.values)
    same = agrees_within_half_percent(number.value, key) and typed.text != spec.unit
    power = power_of_ten_off(value, key)
    if not (same and power) and verdict.note not in POWERS:
        return verdict
    bases = {base for base, _ in typed.dimension}
    if abs(power) == 1 and ("m" not in bases or "kg" in bases):
        return verdict  # ten times is a prefix of lengths only, cm and mm: not of N or W
    asked = format_unit(spec.unit)
    note = "unit-prefix" if same else "unit-prefix-power"
    fields = {"asked": asked, "power": power}
    return attach_values(wrong(verdict.read_as, note, **fields), *verdict.values)


def _diagnose_decibel_factor(value: Value, key: Value, verdict: Verdict) -> Verdict:
    """Return a verdict for 10 in place of 20 in decibels or the other way round, else as it is."""
    if agrees_within_half_percent(value * 2, key):
        return attach_values(wrong(verdict.read_as, "decibel-ten"), *verdict.values)
    if agrees_within_half_percent(value, key * 2):
        return attach_values(wrong(verdict.read_as, "decibel-twenty"), *verdict.values)
    return verdict


def _diagnose_ratio_for_decibel(spec: QuantitySpec, value: Value, read_as: str) -> Verdict | None:
    """Return the wrong verdict on a ratio given where decibels were asked; None if it is none."""
    if spec.unit != "dB" or not value > 0:
        return None
    key = float(parse_exact(spec.value))
    for per_decade in (10, 20):
        if abs(float(value) - 10 ** (key / per_decade)) <= 0.005 * float(value):
            return wrong(read_as, "ratio-for-decibel")
    return None


def ask(part: PartContext) -> AskedPart[QuantitySpec]:
    """Return one number in the unit asked, else in the unit it is shown in."""
    shown_in = part.units.get(asked_quantities(part.answer)[0], "")
    unit = part.answer.get("unit", shown_in)
    return ask_numeric(QuantitySpec, part, unit=unit)


def input_hints(spec: QuantitySpec, lang: str) -> tuple[str, ...]:
    """Return the sentences on unit and rounding."""
    unit = translate(lang, "ask.unit" if spec.bare else "ask.quantity", unit=format_unit(spec.unit))
    return numeric_hints(spec, lang, unit)


KIND = AnswerKind(
    AuthoredQuantity,
    QuantitySpec,
    ask,
    input_hints,
    show_exact_first,
    precision_on_paper,
    accept_within_tolerance,
)
