"""Radial distortion of one point with two coefficients.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), section 7.4, eq. 7.12.
"""

from sympy import Eq, Piecewise, evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

k_1, k_2, x, y = symbols("k_1 k_2 x y", real=True)
R, delta, L, u, v, q = symbols("R delta L x_d y_d q", real=True)

with evaluate(False):
    MODEL = Model(
        given={k_1: "", k_2: "", x: "", y: ""},
        steps=(
            Step(R, x**2 + y**2),
            Step(delta, Piecewise((k_1 * R, Eq(k_2, 0)), (k_1 * R + k_2 * R**2, True))),
            Step(L, 1 + delta),
            Step(u, x * L),
            Step(v, y * L),
            Step(q, L - 1),
        ),
        formulas={"R": "F21", "x_d": "F20", "y_d": "F20"},
        alternatives=(
            Step(q, u / x - 1),
            Step(q, v / y - 1),
        ),
        traps={
            "sign-flipped": Step(L, 1 - delta),
            "r-for-square": Step(R, sqrt(x**2 + y**2)),
            "sum-squared": Step(R, (x + y) ** 2),
            "k2-not-squared": Step(delta, k_1 * R + k_2 * R),
            "factor-added": (Step(u, x + L), Step(v, y + L)),
            "only-x": Step(v, y),
            "shift-only": (Step(u, x * delta), Step(v, y * delta)),
            "each-for-itself": (
                Step(u, x * (1 + k_1 * x**2 + k_2 * x**4)),
                Step(v, y * (1 + k_1 * y**2 + k_2 * y**4)),
            ),
            "inverse": (Step(u, x / L), Step(v, y / L)),
            "factor-for-shift": Step(q, L),
            "absolute-shift": Step(q, delta * sqrt(R)),
        },
    )
