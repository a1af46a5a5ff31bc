"""Perspective projection of one point onto the virtual image plane at z = f.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), eq. 6.1.
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

f, p_x, p_y, p_z = symbols("f p_x p_y p_z", real=True)
u, v = symbols("p'_x p'_y", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "", p_x: "", p_y: "", p_z: ""},
        steps=(Step(u, f * p_x / p_z), Step(v, f * p_y / p_z)),
        formulas={"p'_x": "F05", "p'_y": "F05"},
        traps={
            "divided-by-f": (Step(u, p_x / f), Step(v, p_y / f)),
            "depth-over-f": (Step(u, p_z * p_x / f), Step(v, p_z * p_y / f)),
            "forgot-f": (Step(u, p_x / p_z), Step(v, p_y / p_z)),
            "forgot-depth": (Step(u, f * p_x), Step(v, f * p_y)),
            "range-for-depth": (
                Step(u, f * p_x / sqrt(p_x**2 + p_y**2 + p_z**2)),
                Step(v, f * p_y / sqrt(p_x**2 + p_y**2 + p_z**2)),
            ),
            "swapped": (Step(u, f * p_y / p_z), Step(v, f * p_x / p_z)),
            "physical-plane": (Step(u, -f * p_x / p_z), Step(v, -f * p_y / p_z)),
        },
    )
