"""How much room a calculation gets on paper: squares of 5 mm, by points."""

from __future__ import annotations

import math
from fractions import Fraction

FIRST, EACH, MOST = 2, 2, 14
"""Rows of squares for any calculation, for each point of it, and at most."""


def answer_rows(points: Fraction) -> int:
    """Rows of squares to work in: few for half a point, and no whole page for many."""
    return min(MOST, math.ceil(FIRST + EACH * points))
