"""Undistorting a radius step by step: the distorted radius over the factor of the last estimate.

Source: R. Szeliski, Computer Vision, 2nd ed. (2022), section 2.1.5: no closed inverse is used in
practice, but iteration; with one coefficient it is a fixed-point iteration.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

k_1, r_d, r, x_d, y_d = symbols("k_1 r_d r x_d y_d", real=True)
r_1, r_2, r_3, s, x, y = symbols("r_1 r_2 r_3 s x y", real=True)

with evaluate(False):
    MODEL = Model(
        given={k_1: "", r_d: "", r: "", x_d: "", y_d: ""},
        steps=(
            Step(r_1, r_d / (1 + k_1 * r_d**2)),
            Step(r_2, r_d / (1 + k_1 * r_1**2)),
            Step(r_3, r_d / (1 + k_1 * r_2**2)),
            Step(s, r / r_d),
            Step(x, x_d * s),
            Step(y, y_d * s),
        ),
        formulas={"r_1": "F20", "r_2": "F20", "r_3": "F20"},
        traps={
            "forward": (
                Step(r_1, r_d * (1 + k_1 * r_d**2)),
                Step(r_2, r_d * (1 + k_1 * r_1**2)),
                Step(r_3, r_d * (1 + k_1 * r_2**2)),
            ),
            "sign-only": (
                Step(r_1, r_d * (1 - k_1 * r_d**2)),
                Step(r_2, r_d * (1 - k_1 * r_1**2)),
                Step(r_3, r_d * (1 - k_1 * r_2**2)),
            ),
            "divided-again": (
                Step(r_2, r_1 / (1 + k_1 * r_1**2)),
                Step(r_3, r_2 / (1 + k_1 * r_2**2)),
            ),
            "never-updated": (Step(r_2, r_1), Step(r_3, r_1)),
            "not-squared": (
                Step(r_1, r_d / (1 + k_1 * r_d)),
                Step(r_2, r_d / (1 + k_1 * r_1)),
                Step(r_3, r_d / (1 + k_1 * r_2)),
            ),
            "wrong-way": Step(s, r_d / r),
            "shift-added": (Step(x, x_d + (r - r_d)), Step(y, y_d + (r - r_d))),
        },
    )
