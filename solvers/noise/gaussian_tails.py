"""Gaussian noise: density at zero, and the share of pixels beyond a threshold on either side.

Source: M. Abramowitz, I. Stegun, Handbook of Mathematical Functions (1964), 26.2.1 and 7.1.22.
"""

from sympy import erf, evaluate, pi, sqrt, symbols

from quizgen.maths.model import Model, Step

sigma, t_1, t_2, M = symbols("sigma t_1 t_2 M", positive=True)
g_0, k_1, p_1, P_1, k_2, p_2, P_2, N = symbols("g_0 k_1 p_1 P_1 k_2 p_2 P_2 N", real=True)

with evaluate(False):
    MODEL = Model(
        given={sigma: "", t_1: "", t_2: "", M: "Mpx"},
        steps=(
            Step(g_0, 1 / (sqrt(2 * pi) * sigma)),
            Step(k_1, t_1 / sigma),
            Step(p_1, erf(k_1 / sqrt(2))),
            Step(P_1, 1 - p_1),
            Step(k_2, t_2 / sigma),
            Step(p_2, erf(k_2 / sqrt(2))),
            Step(P_2, 1 - p_2),
            Step(N, M * P_2, "px"),
        ),
        formulas={"g_0": "F16", "p_1": "F18", "p_2": "F18", "N": "F19"},
        traps={
            "variance-in-front": Step(g_0, 1 / (sqrt(2 * pi) * sigma**2)),
            "two-dimensional": Step(g_0, 1 / (2 * pi * sigma**2)),
            "root-forgotten": Step(g_0, 1 / (2 * pi * sigma)),
            "inside": (Step(P_1, p_1), Step(P_2, p_2)),
            "one-sided-tail": (Step(P_1, (1 - p_1) / 2), Step(P_2, (1 - p_2) / 2)),
            "variance-for-sigma": (Step(k_1, t_1 / sigma**2), Step(k_2, t_2 / sigma**2)),
            "percent-not-converted": Step(N, 100 * M * P_2),
            "share-for-count": Step(N, P_2),
        },
    )
