"""Density of the normal law with mean 0 at zero and at two further values.

Source: M. Abramowitz, I. Stegun, Handbook of Mathematical Functions (1964), 26.2.1.
"""

from sympy import evaluate, exp, pi, sqrt, symbols

from quizgen.maths.model import Model, Step

sigma, n_1, n_2 = symbols("sigma n_1 n_2", positive=True)
g_0, g_1, g_2 = symbols("g_0 g_1 g_2", real=True)

with evaluate(False):
    MODEL = Model(
        given={sigma: "", n_1: "", n_2: ""},
        steps=(
            Step(g_0, 1 / (sqrt(2 * pi) * sigma)),
            Step(g_1, g_0 * exp(-(n_1**2) / (2 * sigma**2))),
            Step(g_2, g_0 * exp(-(n_2**2) / (2 * sigma**2))),
        ),
        formulas={"g_0": "F16", "g_1": "F15", "g_2": "F15"},
        traps={
            "half-forgotten": (
                Step(g_1, g_0 * exp(-(n_1**2) / sigma**2)),
                Step(g_2, g_0 * exp(-(n_2**2) / sigma**2)),
            ),
            "sigma-in-exponent": (
                Step(g_1, g_0 * exp(-(n_1**2) / (2 * sigma))),
                Step(g_2, g_0 * exp(-(n_2**2) / (2 * sigma))),
            ),
            "variance-in-front": Step(g_0, 1 / (sqrt(2 * pi) * sigma**2)),
            "root-forgotten": Step(g_0, 1 / (2 * pi * sigma)),
        },
    )
