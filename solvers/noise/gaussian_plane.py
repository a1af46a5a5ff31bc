"""Gaussian in the plane with a diagonal covariance matrix: determinant, peak, density, axes.

Source: R. A. Johnson, D. W. Wichern, Applied Multivariate Statistical Analysis (2007), section 4.2.
"""

from sympy import evaluate, exp, pi, sqrt, symbols

from quizgen.maths.model import Model, Step

sigma_1, sigma_2 = symbols("sigma_1 sigma_2", positive=True)
x, y = symbols("x y", real=True)
d, g_0, q, g, rho = symbols("d g_0 q g rho", real=True)

with evaluate(False):
    MODEL = Model(
        given={sigma_1: "", sigma_2: "", x: "", y: ""},
        steps=(
            Step(d, sigma_1**2 * sigma_2**2),
            Step(g_0, 1 / (2 * pi * sqrt(d))),
            Step(q, x**2 / sigma_1**2 + y**2 / sigma_2**2),
            Step(g, g_0 * exp(-q / 2)),
            Step(rho, sigma_1 / sigma_2),
        ),
        formulas={"g_0": "F40", "g": "F40", "q": "F41"},
        traps={
            "determinant-of-deviations": Step(d, sigma_1 * sigma_2),
            "root-forgotten": Step(g_0, 1 / (2 * pi * d)),
            "one-dimensional": Step(g_0, 1 / (sqrt(2 * pi) * sqrt(d))),
            "half-forgotten": Step(g, g_0 * exp(-q)),
            "matrix-not-inverted": Step(q, sigma_1**2 * x**2 + sigma_2**2 * y**2),
            "variances-as-axes": Step(rho, sigma_1**2 / sigma_2**2),
            "inverted-axes": Step(rho, sigma_2 / sigma_1),
        },
    )
