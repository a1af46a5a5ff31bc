"""Pixel coordinates with pixels that are not square and a camera frame with y up.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), eq. 6.9 without skew.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

f, s_x, s_y, p_x, p_y, p_z = symbols("f s_x s_y p_x p_y p_z", real=True)
o_x, o_y = symbols("o_x o_y", real=True)
f_x, f_y, d_u, d_v, u, v = symbols("f_x f_y d_u d_v u v", real=True)

with evaluate(False):
    MODEL = Model(
        given={
            f: "mm", s_x: "um/px", s_y: "um/px", p_x: "m", p_y: "m", p_z: "m",
            o_x: "px", o_y: "px",
        },
        steps=(
            Step(f_x, f / s_x, "px"),
            Step(f_y, f / s_y, "px"),
            Step(d_u, f_x * p_x / p_z, "px"),
            Step(d_v, f_y * p_y / p_z, "px"),
            Step(u, o_x + d_u, "px"),
            Step(v, o_y - d_v, "px"),
        ),
        formulas={"f_x": "F08", "f_y": "F08", "u": "F09", "v": "F09", "d_u": "F05", "d_v": "F05"},
        traps={
            "y-down": Step(v, o_y + d_v),
            "square-pixels": Step(f_y, f / s_x),
            "pitches-exchanged": (Step(f_x, f / s_y), Step(f_y, f / s_x)),
            "no-principal-point": (Step(u, d_u), Step(v, -d_v)),
            "forgot-depth": (Step(d_u, f_x * p_x), Step(d_v, f_y * p_y)),
            "swapped": (Step(u, o_y - d_v), Step(v, o_x + d_u)),
        },
    )  # fmt: skip
