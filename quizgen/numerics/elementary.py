"""Powers whose exponent is known to twice the working precision."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from quizgen.numerics.typing import Array

Exponent = tuple[float, float]
"""An exponent and what rounding it lost."""

_UNIT = 2.0**-53
_LEAST = 5e-324


def power_with_remainder(x: Array, exponent: Exponent) -> Array:
    """Raise to a power with the exponent carried to twice the working precision."""
    high, low = exponent
    y: Array = x**high
    least = x.min()
    if low == 0 or (least > 0 and abs(low) * max(-math.log(least), math.log(x.max())) < _UNIT):
        return y
    y *= 1 + low * np.log(np.maximum(x, _LEAST))
    return y


def split_exponent(exponent: Fraction) -> Exponent:
    """Nearest double of an exponent, and what that lost."""
    high = float(exponent)
    return high, float(exponent - Fraction(high))


def evaluate_polynomial(coefficients: Sequence[float], x: Array) -> Array:
    """Polynomial with at least two coefficients in ascending order."""
    *rest, second, last = coefficients
    total = x * last
    total += second
    for c in reversed(rest):
        total *= x
        total += c
    return total
