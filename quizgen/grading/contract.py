"""What a kind of answer is: the one interface between the kinds and whoever marks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from quizgen.grading.options import GradingOptions
from quizgen.grading.verdict import Verdict
from quizgen.maths.units import UnitRegistry


class Kind(Protocol):
    """How one part is marked: a struct whose fields are what a key stores, and what they mean.

    A kind is a module of this folder whose ``Spec`` is a struct of this shape, and a row in
    ``KINDS``.
    """

    @property
    def kind(self) -> str:
        """Its name in keys and templates."""
        ...

    @property
    def notes(self) -> Mapping[str, Mapping[str, str]]:
        """Language to what is said to whoever made a known mistake, by the mistake's name."""
        ...

    def validate(self) -> None:
        """Check what types cannot say.

        Raises
        ------
        FormulaError
            If a value cannot be read.
        ValueError
            If fields contradict each other.
        """
        ...

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Judge what was typed.

        Raises
        ------
        ReadError
            If it cannot be read: it is asked back.
        """
        ...

    def show(self) -> str:
        """The key as it is printed, and as it can be typed back."""
        ...

    def show_in(self, lang: str, /) -> str:
        """The same, in the words of a language."""
        ...

    def known_units(self) -> UnitRegistry:
        """The units that may be typed."""
        ...

    def quantities(self) -> list[str]:
        """Names of the chain's quantities that the answer consists of, in order."""
        ...

    def value_units(self) -> list[str]:
        """The unit that each of them is judged in; empty where it is the one the chain shows."""
        ...
