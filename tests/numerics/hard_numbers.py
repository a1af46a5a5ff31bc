"""Doubles at the ends of their range, and steps beside a value."""

from __future__ import annotations

import math

TINY, SMALL, LARGE = 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308
STEPS = (1e-15, 1e-12, 1e-8, 1e-4, 1e-2)


def after(x, steps=1):
    for _ in range(steps):
        x = math.nextafter(x, math.inf)
    return x
