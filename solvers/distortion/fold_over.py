"""Where the distorted radius stops growing, and what that means for a corner of the picture.

Source: the derivative of r (1 + k_1 r^2) is 1 + 3 k_1 r^2; Hartley & Zisserman, Multiple View
Geometry, 2nd ed. (2004), section 7.4, for the model.
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

k_1, r_c = symbols("k_1 r_c", real=True)
r_f, r_m, r_e = symbols("r_f r_m r_e", real=True)

with evaluate(False):
    MODEL = Model(
        given={k_1: "", r_c: ""},
        steps=(
            Step(r_f, 1 / sqrt(-3 * k_1)),
            Step(r_m, r_f * (1 + k_1 * r_f**2)),
            Step(r_e, r_c * (1 + k_1 * r_c**2)),
        ),
        formulas={"r_f": "F22", "r_m": "F20", "r_e": "F20"},
        alternatives=(Step(r_m, r_f * 2 / 3),),
        traps={
            "factor-zero": Step(r_f, 1 / sqrt(-k_1)),
            "no-root": Step(r_f, 1 / (-3 * k_1)),
            "derivative-of-square": Step(r_f, 1 / sqrt(-2 * k_1)),
            "undistorted": Step(r_m, r_f),
            "a-third": Step(r_m, r_f / 3),
            "sign-flipped": (
                Step(r_m, r_f * (1 - k_1 * r_f**2)),
                Step(r_e, r_c * (1 - k_1 * r_c**2)),
            ),
            "not-squared": (Step(r_m, r_f * (1 + k_1 * r_f)), Step(r_e, r_c * (1 + k_1 * r_c))),
            "factor-alone": (Step(r_m, 1 + k_1 * r_f**2), Step(r_e, 1 + k_1 * r_c**2)),
        },
    )
