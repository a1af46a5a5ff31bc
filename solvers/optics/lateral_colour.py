"""Lateral colour: red is imaged a little larger than green, so the shift grows with the radius.

Source: E. Hecht, Optics, 5th ed. (2017), section 6.3.2: lateral chromatic aberration.
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

x, y, q = symbols("x y q", positive=True)
r, d, d_x, r_1 = symbols("r d d_x r_1", real=True)

with evaluate(False):
    MODEL = Model(
        given={x: "px", y: "px", q: "%"},
        steps=(
            Step(r, sqrt(x**2 + y**2), "px"),
            Step(d, q * r, "px"),
            Step(d_x, q * x, "px"),
            Step(r_1, 1 / q, "px"),
        ),
        alternatives=(
            Step(d_x, d * x / r),
            Step(r_1, r / d),
        ),
        traps={
            "sum-of-sides": Step(r, x + y, "px"),
            "magnified": Step(d, (1 + q) * r, "px"),
            "along-y": Step(d_x, q * y, "px"),
            "whole-shift": Step(d_x, d, "px"),
            "half": Step(r_1, 1 / (2 * q), "px"),
            "by-shift": Step(r_1, r * d, "px"),
        },
    )
