"""From a scene point in camera coordinates to pixel coordinates, with square pixels and y down.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), eq. 6.9 without skew.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

f, s, p_x, p_y, p_z = symbols("f s p_x p_y p_z", real=True)
o_x, o_y, W, H = symbols("o_x o_y W H", real=True)
m, f_x, x, y, d_u, d_v, u, v = symbols("m f_x x y d_u d_v u v", real=True)

with evaluate(False):
    MODEL = Model(
        given={
            f: "mm", s: "um/px", p_x: "m", p_y: "m", p_z: "m",
            o_x: "px", o_y: "px", W: "px", H: "px",
        },
        steps=(
            Step(m, 1 / s, "px/m"),
            Step(f_x, m * f, "px"),
            Step(x, p_x / p_z),
            Step(y, p_y / p_z),
            Step(d_u, f_x * x, "px"),
            Step(d_v, f_x * y, "px"),
            Step(u, d_u + o_x, "px"),
            Step(v, d_v + o_y, "px"),
        ),
        formulas={"m": "F08", "f_x": "F08", "u": "F09", "v": "F09", "d_u": "F05", "d_v": "F05"},
        traps={
            "metric-plane": (Step(u, 1000 * f * x), Step(v, 1000 * f * y)),
            "no-principal-point": (Step(u, d_u), Step(v, d_v)),
            "y-up": Step(v, o_y - d_v),
            "swapped": (Step(u, d_v + o_y), Step(v, d_u + o_x)),
            "forgot-depth": (Step(x, p_x), Step(y, p_y)),
            "millimetres": Step(f_x, m * (1000 * f)),
            "pitch-multiplied": Step(f_x, f * s),
            "centre-assumed": (Step(u, d_u + W / 2), Step(v, d_v + H / 2)),
        },
    )  # fmt: skip
