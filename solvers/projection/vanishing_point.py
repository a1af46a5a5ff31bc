"""Where parallel lines of the scene meet in the picture, with square pixels and y down.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), section 8.6.1: v = K d.
"""

from sympy import Add, evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

f, o_x, o_y = symbols("f o_x o_y", real=True)
a_x, a_y, a_z, d_x, d_y, d_z = symbols("a_x a_y a_z d_x d_y d_z", real=True)
x, y, u, v = symbols("x y u v", real=True)

with evaluate(False):
    MODEL = Model(
        given={
            f: "px", o_x: "px", o_y: "px", a_x: "m", a_y: "m", a_z: "m", d_x: "", d_y: "", d_z: "",
        },
        steps=(
            Step(x, d_x / d_z),
            Step(y, d_y / d_z),
            Step(u, o_x + f * x, "px"),
            Step(v, o_y + f * y, "px"),
        ),
        formulas={"u": "F09", "v": "F09"},
        traps={
            "point-of-the-line": (Step(x, a_x / a_z), Step(y, a_y / a_z)),
            "next-point": (Step(x, (a_x + d_x) / (a_z + d_z)), Step(y, (a_y + d_y) / (a_z + d_z))),
            "divided-by-length": (
                Step(x, d_x / sqrt(Add(d_x**2, d_y**2, d_z**2))),
                Step(y, d_y / sqrt(Add(d_x**2, d_y**2, d_z**2))),
            ),
            "depth-left-out": (Step(x, d_x), Step(y, d_y)),
            "upside-down": (Step(x, d_z / d_x), Step(y, d_z / d_y)),
            "swapped": (Step(x, d_y / d_z), Step(y, d_x / d_z)),
            "no-principal-point": (Step(u, f * x), Step(v, f * y)),
            "y-up": Step(v, o_y - f * y),
            "focal-length-left-out": (Step(u, o_x + x), Step(v, o_y + y)),
        },
    )  # fmt: skip
