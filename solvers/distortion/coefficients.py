"""Radial coefficients from measured pairs of undistorted and distorted radius.

Source: Z. Zhang, A flexible new technique for camera calibration (2000), section 3.3: the model is
linear in its coefficients.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

r_1, d_1, r_2, d_2 = symbols("r_1 d_1 r_2 d_2", positive=True)
q_1, q_2, k_0, m, k_2, k_1 = symbols("q_1 q_2 k_0 m k_2 k_1", real=True)

with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys((r_1, d_1, r_2, d_2), ""),
        steps=(
            Step(q_1, d_1 / r_1 - 1),
            Step(k_0, q_1 / r_1**2),
            Step(q_2, d_2 / r_2 - 1),
            Step(m, q_2 / r_2**2),
            Step(k_2, (m - k_0) / (r_2**2 - r_1**2)),
            Step(k_1, k_0 - k_2 * r_1**2),
        ),
        formulas={"q_1": "F20", "k_0": "F20", "q_2": "F20"},
        traps={
            "absolute-shift": (Step(q_1, d_1 - r_1), Step(q_2, d_2 - r_2)),
            "upside-down": (Step(q_1, r_1 / d_1 - 1), Step(q_2, r_2 / d_2 - 1)),
            "factor-for-change": (Step(q_1, d_1 / r_1), Step(q_2, d_2 / r_2)),
            "distorted-square": (Step(k_0, q_1 / d_1**2), Step(m, q_2 / d_2**2)),
            "radii-for-squares": Step(k_2, (m - k_0) / (r_2 - r_1)),
            "first-kept": Step(k_1, k_0),
            "second-added": Step(k_1, k_0 + k_2 * r_1**2),
        },
    )
