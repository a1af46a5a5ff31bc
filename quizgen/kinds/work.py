"""How long an answer takes: one table of what a hand does, and how much of it each kind asks.

The minutes are those of an average prepared student who reads the language of the paper as a
second one; weak ones need about 1.4 times as long, strong ones 0.75 times.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any, Literal, TypeAlias, get_args

Unit: TypeAlias = Literal[
    "question", "word read", "tick", "cell", "step", "line derived", "line of code",
    "word written", "feature drawn", "demand met",
]  # fmt: skip
"""What is done once."""
MINUTES: Mapping[Unit, Fraction] = {
    "question": Fraction("0.3"),
    "word read": Fraction(1, 150),
    "tick": Fraction("0.35"),
    "cell": Fraction("0.25"),
    "step": Fraction("0.65"),
    "line derived": Fraction("0.85"),
    "line of code": Fraction("0.8"),
    "word written": Fraction(1, 18),
    "feature drawn": Fraction("0.45"),
    "demand met": Fraction("1.3"),
}
"""Minutes of each: to find a question, to weigh an option, to put numbers into a formula, ..."""

Verb: TypeAlias = Literal["write", "derive", "sketch", "program", "design", "compute", "tick"]
"""What an answer asks for, as blueprints count it."""
VERBS: tuple[Verb, ...] = get_args(Verb)

Work: TypeAlias = Mapping[Unit, int | Fraction]
WorkCounter: TypeAlias = Callable[[Mapping[str, Any], Fraction, int], Work]
"""From an authored answer, its points and the words of its model answer to what is done.

Steps of a chain are counted where the chain is known, for all kinds alike.
"""


def sum_minutes(work: Work) -> Fraction:
    """Return the minutes that some work takes."""
    return sum((MINUTES[unit] * count for unit, count in work.items()), Fraction(0))


def count_values(answer: Mapping[str, Any], _points: Fraction, _words: int) -> Work:
    """Return one value to be written down for each quantity that is asked, one at least."""
    of = answer.get("of", "")
    return {"cell": 1 if isinstance(of, str) else len(of)}


def count_once(unit: Unit, count: int = 1) -> WorkCounter:
    """Return a counter for kinds whose answers are all as long as each other."""
    return lambda _answer, _points, _words: {unit: count}


def count_listed(unit: Unit, key: str, each: Fraction | int = 1) -> WorkCounter:
    """Return a counter of what an answer lists, as many as are taken in a variant."""

    def count(answer: Mapping[str, Any], _points: Fraction, _words: int) -> Work:
        """Return how many are shown, times ``each``."""
        return {unit: each * (answer.get("take") or len(answer.get(key, ())))}

    return count
