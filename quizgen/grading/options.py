"""How to read an answer, and what is known around it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

import msgspec

from quizgen.core.errors import MathError
from quizgen.maths.chain import Chain
from quizgen.maths.tree import Expr
from quizgen.maths.values import Values

DECIMALS = ("auto", "point", "comma")


@dataclass(frozen=True)
class QuestionContext:
    """The question around a part: enables diagnosis by mutation and carrying errors forward.

    Parameters
    ----------
    chain : Chain
        The question's chain of steps.
    given : mapping of str to flint.fmpq
        The drawn numbers, in base units.
    earlier : mapping of str to flint.fmpq
        The student's own values of quantities asked in earlier parts, in base units.
    forms : mapping of str to Expr
        The student's own formulas, matrices, ... where earlier parts asked for a form and it was
        wrong.
    """

    chain: Chain
    given: Values
    earlier: Values = field(default_factory=dict)
    forms: Mapping[str, Expr] = field(default_factory=dict)
    _solved: list[Values] = field(init=False, repr=False, compare=False, default_factory=list)

    @property
    def solved_values(self) -> Values:
        """The right value of every quantity; empty if the chain does not fit the given numbers.

        Stored in a list: a cached property would hold its own lock while it waits for that of the
        precision.
        """
        if not self._solved:
            self._solved.append(self._solve_given())
        return self._solved[0]

    def _solve_given(self) -> Values:
        """Return the solved values, or none if the chain does not fit the given numbers."""
        try:
            return self.chain.solve(self.given)
        except (MathError, KeyError):
            return {}


class GradingOptions(msgspec.Struct, frozen=True):
    """Reading options: language of the sentences, decimal sign, and the question around.

    ``points`` are the marks of the part, which limit what a missing unit costs; None if it stands
    in no paper.
    ``settle`` allows a few seconds of a computer algebra system, in a process of its own, for a
    formula that sampling cannot decide.
    """

    lang: str = "en"
    decimal: str = "auto"
    context: QuestionContext | None = None
    settle: bool = False
    points: Fraction | None = None
