"""Whole questions in several arithmetics: what a draw solved otherwise would print and mark.

A draw is kept, its numbers are solved again - with balls alone, in float64, in float64 kept to
twelve figures - and its key is made and marked by the product's own code. Nothing else differs.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction

from flint import arb, fmpq

from quizgen.bank.draw import Draw
from quizgen.errors import MathError, QuizgenError
from quizgen.marking.mark import mark, show
from quizgen.marking.specs import AnySpec
from quizgen.maths.chain import Chain
from quizgen.maths.numbers import rational, round_to, to_float
from quizgen.maths.precision import working_precision
from quizgen.maths.systems import NumberSystem, exact, floats
from quizgen.maths.values import AnyNumber, Value, Values
from quizgen.question.kinds import build

FIGURES = 12
"""Significant figures that a careful engine of doubles keeps."""
FREE = frozenset({"text", "witness", "sketch"})
"""Kinds without one printed answer."""
_NUMBER = re.compile(r"[-−]?\d[\d\u202f]*(?:\.\d+)?(?:/\d+)?(?:·10[⁻⁰¹²³⁴-⁹]+)?")
_PLAIN = str.maketrans("−⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "--0123456789", "\u202f")


@dataclass(frozen=True)
class Arithmetic:
    """A way to solve a chain: numbers go in, are computed with, and come out as a key takes them.

    Parameters
    ----------
    system : callable
        Makes the number system.
    enter : callable
        Turns an exact given number into one of the system.
    leave : callable
        Turns a result into a rational or a ball.
    """

    system: Callable[[], NumberSystem]
    enter: Callable[[Value], AnyNumber]
    leave: Callable[[AnyNumber], Value]

    def given(self, values: Values) -> dict[str, AnyNumber]:
        """What is given, as numbers of the system."""
        return {name: self.enter(value) for name, value in values.items()}

    @working_precision()
    def run(self, chain: Chain, given: dict[str, AnyNumber]) -> dict[str, AnyNumber]:
        """Every quantity of a chain: this is what is timed."""
        for name, compiled in chain.compiled(self.system()).items():
            given[name] = compiled(given)
        return given

    def values(self, found: Mapping[str, AnyNumber]) -> dict[str, Value]:
        """What came out, as a key takes it."""
        return {name: self.leave(value) for name, value in found.items()}


def _kept(value: AnyNumber) -> Value:
    kept: Value = value
    return kept


def _as_it_is(value: float) -> fmpq:
    return fmpq(*Fraction(value).as_integer_ratio())


def _to_figures(value: float) -> fmpq:
    if not math.isfinite(value):
        raise MathError("no finite value")
    return rational(f"{value:.{FIGURES}g}")


ARITHMETICS: Mapping[str, Arithmetic] = {
    "float64": Arithmetic(floats, to_float, _as_it_is),
    "rounded": Arithmetic(floats, to_float, _to_figures),
    "balls": Arithmetic(exact, arb, _kept),
    "exact": Arithmetic(exact, _kept, _kept),
}
"""By name: doubles as they are, doubles kept to twelve figures, balls throughout, and rationals that
become balls where a value is irrational, as the product does it."""
FAILURES = (QuizgenError, ZeroDivisionError, OverflowError, ValueError)
"""What an arithmetic raises where it has no answer."""


def solved(drawn: Draw, name: str) -> Draw:
    """The same question, its values as an arithmetic gives them."""
    way, chain = ARITHMETICS[name], drawn.template.chain
    given = way.given({quantity: drawn.values[quantity] for quantity in chain.given})
    return replace(drawn, values=way.values(way.run(chain, given)))


def specs(drawn: Draw) -> list[AnySpec]:
    """What each part of a question is marked by."""
    return [build(drawn, index).spec for index in range(len(drawn.template.rules.part))]


@dataclass(frozen=True)
class Faults:
    """What went wrong with one question in an arithmetic."""

    digit: bool = False
    """The printed key has a wrong digit."""
    accepted: bool = False
    """A wrong answer would be accepted."""
    rejected: bool = False
    """A right answer would be rejected."""
    unanswered: bool = False
    """There is no key at all: the arithmetic cannot decide something."""

    def __or__(self, other: Faults) -> Faults:
        """Either of them."""
        return Faults(*(a or b for a, b in zip(_flags(self), _flags(other), strict=True)))


def _flags(faults: Faults) -> tuple[bool, ...]:
    return faults.digit, faults.accepted, faults.rejected, faults.unanswered


def faults(drawn: Draw, name: str) -> Faults:
    """Compare the key of an arithmetic with the exact one, part by part."""
    found = Faults()
    try:
        others = specs(solved(drawn, name))
        for index, (right, other) in enumerate(zip(specs(drawn), others, strict=True)):
            if right.kind not in FREE and other != right:
                found |= _compared(drawn, index, right, other)
    except FAILURES:
        return replace(found, unanswered=True)
    return found


def _compared(drawn: Draw, index: int, right: AnySpec, other: AnySpec) -> Faults:
    printed, made = show(right), show(other)
    tried = dict.fromkeys([printed, made, *_neighbours(printed), *_mistaken(drawn, index)])
    verdicts = [(_correct(right, typed), _correct(other, typed)) for typed in tried]
    return Faults(
        digit=printed != made and not _right_digits(drawn, index, printed, made),
        accepted=any(theirs and not ours for ours, theirs in verdicts),
        rejected=any(ours and not theirs for ours, theirs in verdicts),
    )


def _correct(spec: AnySpec, typed: str) -> bool:
    return mark(spec, typed, decimal="point").verdict == "correct"


def _mistaken(drawn: Draw, index: int) -> Iterator[str]:
    """What those type who make a known mistake."""
    for spec in build(drawn, index).mistakes.values():
        yield show(spec)


def _neighbours(printed: str) -> Iterator[str]:
    """The printed answer with its first number one higher or lower in the last place."""
    found = _NUMBER.search(printed)
    if found is None or "/" in found[0] or "·" in found[0]:
        return
    number = Decimal(found[0].translate(_PLAIN))
    unit = Decimal(1).scaleb(int(number.as_tuple().exponent))
    for near in (number - unit, number + unit):
        yield f"{printed[: found.start()]}{near:f}{printed[found.end() :]}"


def _right_digits(drawn: Draw, index: int, printed: str, made: str) -> bool:
    """Whether every number of a key is its value rounded to as many places as it has."""
    numbers = [found[0].translate(_PLAIN) for found in _NUMBER.finditer(made)]
    percent = 100 if drawn.plan.parts[index].answer.get("percent") else 1
    values = [value * percent for value in drawn.answer(index)]
    if len(numbers) != len(values) or _words(printed) != _words(made):
        return False
    return all(map(_rounds_to, values, numbers))


def _words(text: str) -> str:
    return _NUMBER.sub("", text)


def _rounds_to(value: Value, number: str) -> bool:
    if "/" in number:
        return isinstance(value, fmpq) and value == rational(number)
    mantissa, _, power = number.partition("·10")
    size = fmpq(10) ** int(power or 0)
    places = -int(Decimal(mantissa).as_tuple().exponent)
    with working_precision():
        return bool(round_to(value / size, places) == rational(mantissa))
