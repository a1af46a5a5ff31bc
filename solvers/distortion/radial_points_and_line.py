"""Radial distortion of two points on the x axis, and of a vertical line that misses the centre.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), section 7.4, eq. 7.12.
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

k_1, x_A, x_B, b = symbols("k_1 x_A x_B b", real=True)
R_A, L_A, u_A, v_A, R_B, L_B, u_B, v_B = symbols("R_A L_A u_A v_A R_B L_B u_B v_B", real=True)
g_A, g_B, R_b, u_b, sag = symbols("g_A g_B R_b u_b s", real=True)

with evaluate(False):
    MODEL = Model(
        given={k_1: "", x_A: "", x_B: "", b: ""},
        steps=(
            Step(R_A, x_A**2),
            Step(L_A, 1 + k_1 * R_A),
            Step(u_A, x_A * L_A),
            Step(v_A, 0 * L_A),
            Step(R_B, x_B**2),
            Step(L_B, 1 + k_1 * R_B),
            Step(u_B, x_B * L_B),
            Step(v_B, 0 * L_B),
            Step(g_A, u_A / x_A),
            Step(g_B, (u_B - u_A) / (x_B - x_A)),
            Step(R_b, x_A**2 + b**2),
            Step(u_b, x_A * (1 + k_1 * R_b)),
            Step(sag, u_b - u_A),
        ),
        formulas={
            "R_A": "F21",
            "u_A": "F20",
            "v_A": "F20",
            "R_B": "F21",
            "u_B": "F20",
            "v_B": "F20",
            "R_b": "F21",
            "u_b": "F20",
        },
        traps={
            "r-for-square": (Step(R_A, x_A), Step(R_B, x_B)),
            "sign-flipped": (Step(L_A, 1 - k_1 * R_A), Step(L_B, 1 - k_1 * R_B)),
            "factor-added": (Step(u_A, x_A + L_A), Step(u_B, x_B + L_B)),
            "shift-only": (Step(u_A, x_A * k_1 * R_A), Step(u_B, x_B * k_1 * R_B)),
            "inverse": (Step(u_A, x_A / L_A), Step(u_B, x_B / L_B)),
            "inner-for-outer": Step(g_B, u_A / x_A),
            "whole-radius": Step(g_B, u_B / x_B),
            "absolute-gap": Step(g_B, u_B - u_A),
            "loss-for-rest": Step(g_B, 1 - (u_B - u_A) / (x_B - x_A)),
            "radius-not-squared": Step(R_b, sqrt(x_A**2 + b**2)),
            "height-for-radius": Step(R_b, b**2),
            "whole-shift": Step(sag, u_b - x_A),
            "sag-upside-down": Step(sag, u_A - u_b),
            "sag-of-height": Step(sag, b * k_1 * b**2),
        },
    )
