"""How two groups travel, as counts and as percentages of rows, columns or all."""

import numpy as np


def draw(rng):
    shares = rng.uniform(0.15, 0.6, (2, 3))
    counts = np.array(
        [rng.multinomial(n, s / s.sum()) for n, s in zip((100, 150), shares, strict=True)]
    )
    kind = int(rng.integers(0, 3))
    whole = (counts.sum(1, keepdims=True), counts.sum(0, keepdims=True), counts.sum())[kind]
    percent = (100 * counts / whole).round(1).ravel()
    if len(set(percent)) < 6 or counts.min() < 8:
        return None
    one, other = rng.permutation(["apprentices", "students", "teachers", "clerks"])[:2]
    return {"n": counts.ravel(), "p": percent, "k": kind, "one": str(one), "other": str(other)}
