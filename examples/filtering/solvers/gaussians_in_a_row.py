"""Two Gaussian filters one after the other are one Gaussian filter: variances add.

Source: Szeliski, Computer Vision, 2nd ed. (2022), section 3.2.
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

a, b, T = symbols("sigma_1 sigma_2 sigma_3", positive=True)
V, c, U, r = symbols("V sigma U rho", positive=True)

with evaluate(False):
    MODEL = Model(
        given={a: "px", b: "px", T: "px"},
        steps=(
            Step(V, a**2 + b**2, "px^2"),
            Step(c, sqrt(V), "px"),
            Step(U, T**2 - V, "px^2"),
            Step(r, sqrt(U), "px"),
        ),
        traps={
            "added": Step(c, a + b),
            "once-more": Step(c, sqrt(a * b)),
            "mean": Step(c, (a + b) / 2),
            "rest-subtracted": Step(r, T - c),
            "only-second": Step(U, T**2 - b**2),
            "variances-added-again": Step(U, T**2 + V),
        },
    )
