"""Whole questions in several arithmetics: a draw's numbers are kept, and solved again."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from flint import arb, fmpq

from quizgen.bank.variant import Variant
from quizgen.core.errors import MathError, QuizgenError
from quizgen.maths.chain import Chain
from quizgen.maths.number_systems import NumberSystem, exact_system, float64_system
from quizgen.maths.numbers import to_float, to_rational
from quizgen.maths.precision import working_precision
from quizgen.maths.values import AnyNumber, Value, Values
from quizgen.numerics.rational import exact_fraction

FIGURES = 12
"""Significant figures that a careful engine of doubles keeps."""


@dataclass(frozen=True)
class Arithmetic:
    """One way to solve a chain: its number system, and the conversions in and out.

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

    def convert_given(self, values: Values) -> dict[str, AnyNumber]:
        """Return the given quantities as numbers of the system."""
        return {name: self.enter(value) for name, value in values.items()}

    @working_precision()
    def run(self, chain: Chain, given: dict[str, AnyNumber]) -> dict[str, AnyNumber]:
        """Return every quantity of a chain; this is what is timed."""
        for name, compiled in chain.compile_steps(self.system()).items():
            given[name] = compiled(given)
        return given

    def values(self, found: Mapping[str, AnyNumber]) -> dict[str, Value]:
        """Return results as rationals or balls, as a key takes them."""
        return {name: self.leave(value) for name, value in found.items()}


def _return_unchanged(value: AnyNumber) -> Value:
    """Return a value as it is, where the key takes what the system computes."""
    kept: Value = value
    return kept


def _round_to_figures(value: float) -> fmpq:
    """Return a float rounded to ``FIGURES`` significant figures.

    Raise `MathError` if not finite.
    """
    if not math.isfinite(value):
        raise MathError("no finite value")
    return to_rational(f"{value:.{FIGURES}g}")


ARITHMETICS: Mapping[str, Arithmetic] = {
    "float64": Arithmetic(float64_system, to_float, exact_fraction),
    "rounded": Arithmetic(float64_system, to_float, _round_to_figures),
    "balls": Arithmetic(exact_system, arb, _return_unchanged),
    "exact": Arithmetic(exact_system, _return_unchanged, _return_unchanged),
}
"""By name: doubles as they are, doubles kept to twelve figures, balls throughout, and rationals
that become balls where a value is irrational, as the product does it."""
FAILURES = (QuizgenError, ZeroDivisionError, OverflowError, ValueError)
"""What an arithmetic raises where it has no answer."""


def draws_list(drawn: Variant) -> bool:
    """Return whether a question computes from a list; only the exact arithmetic has those."""
    return any(isinstance(drawn.values[name], tuple) for name in drawn.template.chain.given)


def solve_in(drawn: Variant, name: str) -> Variant:
    """Return the same variant with the values that an arithmetic of this name gives."""
    way, chain = ARITHMETICS[name], drawn.template.chain
    given = way.convert_given({quantity: drawn.values[quantity] for quantity in chain.given})
    return replace(drawn, values=way.values(way.run(chain, given)))
