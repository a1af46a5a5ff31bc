"""Kind ``angle``: degrees (or radians, converted), compared on the circle."""

from __future__ import annotations

from contextlib import suppress
from typing import ClassVar

from flint import fmpq

from quizgen.grading.diagnosis.carry_forward import diagnosis_for
from quizgen.grading.diagnosis.numeric_slips import agrees_within_half_percent, is_in_radians
from quizgen.grading.judging.numeric import NumberTarget, best_verdict, judge_readings, judge_value
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.angle_spellings import list_angle_spellings
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.equalities import EqualitySide, read_typed_sides
from quizgen.grading.reading.numbers import ReadNumber
from quizgen.grading.reading.quantities import TypedQuantity
from quizgen.grading.rounding import format_key
from quizgen.grading.spec import ScalarSpec
from quizgen.grading.verdict import Verdict, attach_values, wrong
from quizgen.kinds.asking import (
    accept_within_tolerance,
    ask_numeric,
    numeric_hints,
    precision_on_paper,
    show_exact_first,
)
from quizgen.kinds.contract import AnswerKind, AskedPart, AuthoredNumeric, PartContext
from quizgen.kinds.quantity import DEGREES
from quizgen.locale import translate
from quizgen.maths.constants import Scalar, parse_exact
from quizgen.maths.notation import FormulaReadError, pretty
from quizgen.maths.tolerance import AngleTolerance
from quizgen.maths.units import format_unit
from quizgen.maths.values import Value


class AuthoredAngle(AuthoredNumeric, tag="angle", frozen=True):
    """An angle in degrees."""

    period: Scalar = 360


class AngleSpec(ScalarSpec, kw_only=True, frozen=True):
    """Angle: ``value`` in degrees; ``period`` (default 360, 0 for none).

    Without a tolerance half a degree is accepted. A bare number counts as degrees.
    """

    written_as: ClassVar[AnswerForm] = "number"

    period: Scalar = 360

    unstated: ClassVar[tuple[str, Scalar]] = AngleTolerance.unstated

    def validate(self) -> None:
        """Check tolerance, value, period and traps; errors as ``WordSpec.validate``."""
        super().validate()
        parse_exact(self.period)

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on a typed angle; of equal ones that were chained the best.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """
        found: list[Verdict] = []
        for text in list_angle_spellings(self._close_turn(typed, options)):
            with suppress(FormulaReadError):
                sides = read_typed_sides(text, options.decimal)
                found.append(best_verdict(_judge_equal_side(self, side, options) for side in sides))
        if not found:
            read_typed_sides(typed, options.decimal)
        return max(reversed(found), key=lambda verdict: verdict.credit)

    def _close_turn(self, typed: str, options: GradingOptions) -> str:
        """Return the last of two angles that differ by whole turns, ``-30° = 330°``."""
        *_, before, last = ["", *typed.split("=")]
        period = parse_exact(self.period) or fmpq(360)
        if not before:
            return typed
        try:
            found = [read_typed_sides(one.strip(), options.decimal)[0] for one in (before, last)]
        except FormulaReadError:
            return typed
        first, second = (side.readings.main.value for side in found)
        turns = (first - second) / period
        whole = isinstance(turns, fmpq) and turns.q == 1 and turns != 0
        return last.strip() if whole else typed

    @property
    def printed_unit(self) -> str:
        """The unit that is printed beside the field on paper."""
        return "°"

    def show(self) -> str:
        """Return the key as printed and as it can be typed back."""
        return f"{pretty.format_number(format_key(self, parse_exact(self.value)))}°"


def _judge_equal_side(spec: AngleSpec, side: EqualitySide, options: GradingOptions) -> Verdict:
    """Return the verdict on one side, whose number may have two readings."""
    return judge_readings(
        side.readings, lambda n: _judge_degrees(spec, n, side.quantity, options), spec.decimals
    )


def _judge_degrees(
    spec: AngleSpec, number: ReadNumber, quantity: TypedQuantity, options: GradingOptions
) -> Verdict:
    """Return the verdict on one reading of a number, converted to degrees.

    A wrong number without a unit may be the angle in radians, which has a note of its own.
    """
    read_as = (
        f"{number.read_as}°" if quantity.unit is None else _format_typed_angle(number, quantity)
    )
    factor = fmpq(1)
    if quantity.unit is not None:
        if quantity.unit.dimension != DEGREES:
            return wrong(read_as, "unit-clash", given=format_unit(quantity.unit.text), asked="°")
        factor = quantity.unit.factor
    value = number.value * factor
    verdict = _judge_on_circle(spec, number, value, read_as, options)
    bare = quantity.unit is None and not verdict.credit
    if (
        bare
        and not verdict.note.startswith("trap:")
        and is_in_radians(number.value, parse_exact(spec.value))
    ):
        verdict = wrong(read_as, "radians")
    elif (
        not verdict.credit
        and not verdict.note
        and agrees_within_half_percent(-value, parse_exact(spec.value))
    ):
        verdict = wrong(read_as, "sign")
    return attach_values(verdict, value)


def _format_typed_angle(number: ReadNumber, quantity: TypedQuantity) -> str:
    """Return the number with its unit, a degree sign close to it."""
    text = quantity.unit.text if quantity.unit else ""
    return f"{number.read_as}°" if text in {"deg", "°"} else f"{number.read_as} {text}"


def _judge_on_circle(
    spec: AngleSpec, number: ReadNumber, value: Value, read_as: str, options: GradingOptions
) -> Verdict:
    """Return the verdict on degrees: key and mistakes are compared a turn more or less."""
    key = parse_exact(spec.value)
    traps = [(name, nearest_turn(spec, trap, value)) for name, trap in spec.trap_values()]
    hints = diagnosis_for(spec, number, fmpq(1), options)
    asked = NumberTarget(spec, nearest_turn(spec, key, value), traps, hints=hints)
    return judge_value(asked, number, value, read_as)


def nearest_turn(spec: AngleSpec, target: Value, value: Value) -> Value:
    """Return the angle that differs from a target by whole turns and is nearest to a value.

    Both are in degrees; without a period it is the target itself.
    """
    period = parse_exact(spec.period)
    if period == 0:
        return target
    turns = (value - target) / period
    exact = turns if isinstance(turns, fmpq) else turns.mid().fmpq()
    return target + period * fmpq((exact + fmpq(1, 2)).floor())


def ask(part: PartContext) -> AskedPart[AngleSpec]:
    """Return one angle, and the angle that each mistake gives."""
    return ask_numeric(AngleSpec, part)


def input_hints(spec: AngleSpec, lang: str) -> tuple[str, ...]:
    """Return the sentences on degrees and rounding."""
    return numeric_hints(spec, lang, translate(lang, "ask.degrees"))


KIND = AnswerKind(
    AuthoredAngle,
    AngleSpec,
    ask,
    input_hints,
    show_exact_first,
    precision_on_paper,
    accept_within_tolerance,
)
