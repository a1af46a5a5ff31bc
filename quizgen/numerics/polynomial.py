"""Polynomials on blocks of ordinary arrays."""

from __future__ import annotations

from collections.abc import Sequence

from quizgen.numerics.typing import Array


def evaluate_polynomial(coefficients: Sequence[float], x: Array) -> Array:
    """Polynomial with at least two coefficients in ascending order."""
    *rest, second, last = coefficients
    total = x * last
    total += second
    for c in reversed(rest):
        total *= x
        total += c
    return total
