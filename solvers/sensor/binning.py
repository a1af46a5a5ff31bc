"""Binning: k x k photosites as one pixel, read out one by one or together.

Source: J. R. Janesick, Photon Transfer (2007), chapter 3: independent noises add in squares, and a
count of electrons has its mean as variance.
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

S, sigma_r, k, p = symbols("S sigma_r k p", positive=True)
E, Q, Q_2, T = symbols("E Q Q_2 T", real=True)

with evaluate(False):
    MODEL = Model(
        given={S: "e-", sigma_r: "e-", k: "", p: "um"},
        steps=(
            Step(E, k**2 * S, "e-"),
            Step(Q, E / sqrt(E + k**2 * sigma_r**2)),
            Step(Q_2, E / sqrt(E + sigma_r**2)),
            Step(T, 2 * (k * p), "um"),
        ),
        traps={
            "side-for-area": (Step(E, k * S, "e-"), Step(Q, E / sqrt(E + k * sigma_r**2))),
            "one-photosite": Step(Q, S / sqrt(S + sigma_r**2)),
            "read-noise-not-squared": Step(Q, E / sqrt(E + k**2 * sigma_r)),
            "shot-noise-left-out": Step(Q, E / sqrt(k**2 * sigma_r**2)),
            "variance-for-deviation": Step(Q, E / (E + k**2 * sigma_r**2)),
            "read-once-not-squared": Step(Q_2, E / sqrt(E + sigma_r)),
            "read-alone": Step(Q_2, E / sigma_r),
            "one-pixel": Step(T, k * p, "um"),
            "before-binning": Step(T, 2 * p, "um"),
            "area-of-block": Step(T, 2 * (k**2 * p), "um"),
        },
    )
