"""Scores of four groups, cut to the scale from 0 to 10."""

import numpy as np


def draw(rng):
    means = 5 + rng.uniform(0, 1.4) * rng.normal(0, 1, 4)
    spread = rng.uniform(1, 1.8)
    groups = [np.clip(rng.normal(m, spread, rng.integers(10, 16)), 0, 10) for m in means]
    return {
        name: group.round(1)
        for name, group in zip(("x_1", "x_2", "x_3", "x_4"), groups, strict=True)
    }
