"""Two samples that differ clearly, or agree clearly, in place, spread and skew."""

import numpy as np


def draw(rng):
    found = {}
    for name in "xy":
        shape = rng.choice([-1, 0, 1])
        z = rng.normal(0, 1, rng.integers(8, 13))
        z = np.exp(0.9 * shape * z) * shape if shape else z
        found[name] = (rng.uniform(40, 60) + rng.choice([4, 12]) * z).round(1)
        low, middle, high = np.quantile(found[name], (0.25, 0.5, 0.75))
        skew = (high + low - 2 * middle) / (high - low)
        if 0.12 < abs(skew) < 0.3:
            return None
    place = abs(np.subtract(*(np.median(z) for z in found.values())))
    spread = [np.subtract(*np.quantile(z, (0.75, 0.25))) for z in found.values()]
    if place < 4 or min(spread) / max(spread) > 0.6:
        return None
    return found
