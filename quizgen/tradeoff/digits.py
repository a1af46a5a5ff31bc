"""How right a number is, for people: its correct decimal digits."""

from __future__ import annotations

import math

MOST_DIGITS = 16
ALL_DIGITS = 17.0
"""Stands for a result that is right to the last bit."""


def correct_digits(value: float, truth: float, turn: float = 0.0) -> float:
    """Correct decimal digits of a result: 0 to 16, or 17 if it is the nearest double."""
    if math.isnan(value) or math.isinf(value) != math.isinf(truth):
        return 0.0
    if value == truth:
        return ALL_DIGITS
    if turn:
        off = abs((value - truth + turn / 2) % turn - turn / 2) / turn
        return _convert_error_to_digits(off) if off else ALL_DIGITS
    return _convert_error_to_digits(abs(value - truth) / abs(truth)) if truth else 0.0


def _convert_error_to_digits(relative: float) -> float:
    return min(max(0.0, -math.log10(relative)), float(MOST_DIGITS))
