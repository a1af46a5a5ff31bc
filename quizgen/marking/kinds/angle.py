"""Kind ``angle``: degrees (or radians, converted), compared on the circle."""

from __future__ import annotations

from typing import ClassVar

from flint import fmpq

from quizgen.marking.diagnosis.context import hints_for
from quizgen.marking.diagnosis.slips import close, radians
from quizgen.marking.judging.number import Asked, best, judge_value, resolve
from quizgen.marking.kinds.quantity import DEGREES
from quizgen.marking.options import Options
from quizgen.marking.reading.chains import Side, plain_side, read_sides
from quizgen.marking.reading.named import without_name
from quizgen.marking.reading.quantities import TypedQuantity
from quizgen.marking.reading.rewrites import normalise
from quizgen.marking.reading.scalars import Number
from quizgen.marking.rounding import shown
from quizgen.marking.specs import OneNumber
from quizgen.marking.verdict import Verdict, with_values, wrong
from quizgen.maths.constants import Scalar, exact_value
from quizgen.maths.notation import people
from quizgen.maths.tolerance import AngleTolerance
from quizgen.maths.units import shown as shown_unit
from quizgen.maths.values import Value


class Spec(OneNumber, kw_only=True, frozen=True):
    """Angle: ``value`` in degrees; ``period`` (default 360, 0 for none).

    Without a tolerance half a degree is accepted. A bare number counts as degrees.
    """

    period: Scalar = 360

    unstated: ClassVar[tuple[str, Scalar]] = AngleTolerance.unstated

    def validate(self) -> None:
        """Check tolerance, value, period and traps."""
        super().validate()
        exact_value(self.period)

    def judge(self, typed: str, options: Options, /) -> Verdict:
        """Judge a typed angle."""
        plain = plain_side(typed, options.decimal)
        if plain is not None:
            return _resolved(self, plain, options)
        sides = read_sides(without_name(normalise(typed)), options.decimal)
        return best(_resolved(self, side, options) for side in sides)

    def show(self) -> str:
        """Return the key as printed and as it can be typed back."""
        return f"{people.number(shown(self, exact_value(self.value)))}°"


def _resolved(spec: Spec, side: Side, options: Options) -> Verdict:
    return resolve(side.readings, lambda n: _judge(spec, n, side.quantity, options), spec.decimals)


def _judge(spec: Spec, number: Number, quantity: TypedQuantity, options: Options) -> Verdict:
    read_as = f"{number.read_as}°" if quantity.unit is None else _echo(number, quantity)
    factor = fmpq(1)
    if quantity.unit is not None:
        if quantity.unit.dimension != DEGREES:
            return wrong(read_as, "unit-clash", given=shown_unit(quantity.unit.text), asked="°")
        factor = quantity.unit.factor
    value = number.value * factor
    verdict = _on_circle(spec, number, value, read_as, options)
    bare = quantity.unit is None and not verdict.credit
    if (
        bare
        and not verdict.note.startswith("trap:")
        and radians(number.value, exact_value(spec.value))
    ):
        verdict = wrong(read_as, "radians")
    elif not verdict.credit and not verdict.note and close(-value, exact_value(spec.value)):
        verdict = wrong(read_as, "sign")
    return with_values(verdict, value)


def _echo(number: Number, quantity: TypedQuantity) -> str:
    text = quantity.unit.text if quantity.unit else ""
    return f"{number.read_as}°" if text in {"deg", "°"} else f"{number.read_as} {text}"


def _on_circle(spec: Spec, number: Number, value: Value, read_as: str, options: Options) -> Verdict:
    key = exact_value(spec.value)
    traps = [(name, around(spec, trap, value)) for name, trap in spec.trap_values()]
    hints = hints_for(spec, number, fmpq(1), options)
    asked = Asked(spec, around(spec, key, value), traps, hints=hints)
    return judge_value(asked, number, value, read_as)


def around(spec: Spec, target: Value, value: Value) -> Value:
    """Return the representative of a target on the circle that is nearest to a value."""
    period = exact_value(spec.period)
    if period == 0:
        return target
    turns = (value - target) / period
    exact = turns if isinstance(turns, fmpq) else turns.mid().fmpq()
    return target + period * fmpq((exact + fmpq(1, 2)).floor())
