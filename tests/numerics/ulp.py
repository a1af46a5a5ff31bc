"""Distance between a double and the truth, in units in the last place of the rounded truth."""

from __future__ import annotations

import math

import mpmath as mp


def ulps(value: float, truth: mp.mpf) -> float:
    """Error of ``value`` in units in the last place of ``truth`` rounded to binary64.

    Overflow follows SciPy's rule: a truth beyond the largest double counts as infinity.
    """
    value = float(value)
    if mp.isinf(truth) or abs(truth) >= mp.mpf(2) ** 1024 * (1 - mp.mpf(2) ** -54):
        right = math.isinf(value) and (value > 0) == (truth > 0)
        return 0.0 if right else math.inf
    if math.isnan(value) or math.isinf(value):
        return math.inf
    with mp.workdps(60):
        spacing = math.ulp(float(truth))
        return float(abs(mp.mpf(value) - truth) / mp.mpf(spacing))
