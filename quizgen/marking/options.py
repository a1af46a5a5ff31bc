"""How to read an answer, and what is known around it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from quizgen.errors import MathError
from quizgen.maths.chain import Chain

DECIMALS = ("auto", "point", "comma")


@dataclass(frozen=True)
class Context:
    """The question around a part: enables diagnosis by mutation and carrying errors forward.

    Parameters
    ----------
    chain : Chain
        The question's chain of steps.
    given : mapping of str to flint.fmpq
        The drawn numbers, in base units.
    earlier : mapping of str to flint.fmpq
        The student's own values of quantities asked in earlier parts, in base units.
    """

    chain: Chain
    given: Mapping[str, Any]
    earlier: Mapping[str, Any] = field(default_factory=dict)

    @cached_property
    def solved(self) -> dict[str, Any]:
        """The right value of every quantity; empty if the chain does not fit the given numbers."""
        try:
            return self.chain.solve(self.given)
        except (MathError, KeyError):
            return {}


@dataclass(frozen=True, slots=True)
class Options:
    """Reading options: language of the sentences, decimal sign, and the question around.

    ``settle`` allows a few seconds of a computer algebra system, in a process of its own, for a
    formula that sampling cannot decide.
    """

    lang: str = "en"
    decimal: str = "auto"
    context: Context | None = None
    settle: bool = False


PLAIN = Options()
