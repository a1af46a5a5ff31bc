"""Loads and extensions of a wire, measured well or badly."""

import numpy as np


def draw(rng):
    x = np.sort(rng.choice(np.arange(1, 13), rng.integers(5, 9), replace=False))
    y = 1 + 0.4 * x + rng.normal(0, rng.choice([0.5, 1.6]), x.size)
    return {"n": x.size, "x": x, "y": y.round(1)} if y.min() > 0 else None
