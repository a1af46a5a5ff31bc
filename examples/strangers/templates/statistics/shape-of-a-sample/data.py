"""Forty waiting times of a drawn shape, some with values far outside."""

import numpy as np


def draw(rng):
    """Return times with one hump or two, and how they are skewed."""
    two, skew, far = int(rng.integers(0, 2)), int(rng.integers(-1, 2)), int(rng.integers(0, 2))
    if two:
        skew = 0
        x = np.concatenate([rng.normal(12, 1.5, 20), rng.normal(28, 1.5, 20)])
    elif skew:
        x = 20 + skew * (rng.exponential(5, 40) - 5)
    else:
        x = rng.normal(20, 2, 40)
    if far and not skew:
        x[:2] = [20 + 45 * (1 + two), 20 - 45 * two + 48]
    if (x <= 0).any():
        return None
    return {"x": rng.permutation(x), "two": two, "skew": skew}
