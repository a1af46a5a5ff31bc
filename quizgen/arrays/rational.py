"""Doubles as the fractions they are, and back."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import SupportsIndex

from quizgen.arrays.aliases import Array


def nearest(value: Fraction | float) -> float:
    """Round a rational (or a float that stands for itself) to the nearest float."""
    if isinstance(value, float):
        return value
    try:
        return value.numerator / value.denominator
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def read_decimal(value: float | Fraction) -> Fraction:
    """Read a number as it is written: 2.2 is eleven fifths, not the nearest binary fraction."""
    return Fraction(repr(value)) if isinstance(value, float) else Fraction(value)


def exactly(args: Sequence[Array], i: SupportsIndex) -> list[Fraction]:
    """Element i of every argument; a single number stands for all elements."""
    return [Fraction(float(arg[i if arg.size > 1 else 0])) for arg in args]
