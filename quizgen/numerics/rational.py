"""Doubles as the fractions they are, and back."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import SupportsIndex

from flint import fmpq

from quizgen.numerics.domain import Array


def nearest_double(value: fmpq) -> float:
    """Return the float nearest to a fraction, infinity beyond the range."""
    try:
        return int(value.p) / int(value.q)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def exact_fraction(value: float) -> fmpq:
    """Return the fraction that a finite double is exactly."""
    return fmpq(*value.as_integer_ratio())


def exact_arguments(args: Sequence[Array], i: SupportsIndex) -> list[fmpq]:
    """Return element i of every argument as a fraction; an array of one stands for all elements."""
    return [exact_fraction(arg.item(i if arg.size > 1 else 0)) for arg in args]
