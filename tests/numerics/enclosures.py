"""Numbers for proofs: exact values over a box of inputs, with how far rounding may move them.

The code of a kernel runs on them unchanged. Premises: the four operations and the square root round
correctly; NumPy's exponential, logarithm and power are right to one unit in the last place.
"""

from __future__ import annotations

import numpy as np
from flint import arb, arb_series

UNIT = arb(2) ** -53
ORDER = 14
"""Terms of the Taylor series on a box."""


class Box:
    """Exact values over a box, and the largest error of the computed ones."""

    def __init__(self, value, error=0):
        self.value, self.error = arb(value), arb(error)

    def _rounded(self, value, error):
        return Box(value, (error + UNIT * (abs(value) + error)).upper())

    def __add__(self, other):
        other = other if isinstance(other, Box) else Box(other)
        return self._rounded(self.value + other.value, self.error + other.error)

    def __neg__(self):
        return Box(-self.value, self.error)

    def __sub__(self, other):
        return self + -(other if isinstance(other, Box) else Box(other))

    def __rsub__(self, other):
        return Box(other) - self

    def __mul__(self, other):
        other = other if isinstance(other, Box) else Box(other)
        error = abs(self.value) * other.error + abs(other.value) * self.error
        return self._rounded(self.value * other.value, error + self.error * other.error)

    def __truediv__(self, other):
        value = self.value / other.value
        error = (self.error + abs(value) * other.error) / (abs(other.value) - other.error)
        return self._rounded(value, error)

    __radd__, __rmul__ = __add__, __mul__


def boxes(low, high, count):
    """Interval cut into pieces that overlap in their ends."""
    width = (arb(high) - arb(low)) / count
    for i in range(count):
        yield arb(low) + width * (i + arb("0.5")) + arb(0, (width / 2).upper())


def farthest(difference, box):
    """Enclose a function over a box by its Taylor series in the middle."""
    middle, radius = arb(box.mid()), arb(0, box.rad().upper())
    terms = difference(arb_series([middle, 1], prec=ORDER)).coeffs()
    rests = difference(arb_series([box, 1], prec=ORDER)).coeffs()
    total = rests[-1]
    for term in reversed(terms[: len(rests) - 1]):
        total = total * radius + term
    return total


def on_one(formula, box):
    """Run code for arrays on one box."""
    return formula(np.array([Box(box)], dtype=object))[0]
