"""Simulated data on a line, perhaps after taking logarithms, and the fit's printed summary."""

import numpy as np
from scipy import stats


def draw(rng):
    kind = int(rng.integers(0, 3))
    n = int(rng.integers(40, 90))
    x = rng.uniform(1, 10, n)
    slope = rng.choice([0, 0.1, 0.3, -0.3])
    y = rng.uniform(1, 3) + slope * (np.log(x) if kind == 2 else x) + rng.normal(0, 0.5, n)
    fit = stats.linregress(np.log(x) if kind == 2 else x, y)
    if 0.01 < fit.pvalue < 0.1:
        return None
    t, t_0 = fit.slope / fit.stderr, fit.intercept / fit.intercept_stderr
    return {
        "n": n, "kind": kind, "starred": int(fit.pvalue < 0.05), "df": n - 2,
        "a": round(fit.intercept, 4), "b": round(fit.slope, 4), "R": round(fit.rvalue**2, 4),
        "s_a": round(fit.intercept_stderr, 4), "s_b": round(fit.stderr, 4),
        "t_a": round(t_0, 3), "t_b": round(t, 3), "p": round(fit.pvalue, 4),
    }  # fmt: skip
