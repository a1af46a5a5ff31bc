"""From a pixel back to the ray of scene points, and to the point at a known depth, with y down.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), section 6.2.2:
the ray of a pixel is K^-1 x.
"""

from sympy import Add, evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

u, v, o_x, o_y, f_x, f_y, Z = symbols("u v o_x o_y f_x f_y Z", real=True)
x, y, X, Y, d = symbols("x y X Y d", real=True)

with evaluate(False):
    MODEL = Model(
        given={u: "px", v: "px", o_x: "px", o_y: "px", f_x: "px", f_y: "px", Z: "m"},
        steps=(
            Step(x, (u - o_x) / f_x),
            Step(y, (v - o_y) / f_y),
            Step(X, x * Z, "m"),
            Step(Y, y * Z, "m"),
            Step(d, sqrt(Add(X**2, Y**2, Z**2)), "m"),
        ),
        formulas={"x": "F09", "y": "F09", "X": "F10", "Y": "F10"},
        alternatives=(Step(d, Z * sqrt(Add(1, x**2, y**2))),),
        traps={
            "no-principal-point": (Step(x, u / f_x), Step(y, v / f_y)),
            "y-up": Step(y, (o_y - v) / f_y),
            "focal-lengths-exchanged": (Step(x, (u - o_x) / f_y), Step(y, (v - o_y) / f_x)),
            "one-focal-length": Step(y, (v - o_y) / f_x),
            "upside-down": (Step(x, f_x / (u - o_x)), Step(y, f_y / (v - o_y))),
            "focal-length-left-out": (Step(x, u - o_x), Step(y, v - o_y)),
            "divided-by-depth": (Step(X, x / Z), Step(Y, y / Z)),
            "depth-left-out": (Step(X, x), Step(Y, y)),
            "across-only": Step(d, sqrt(X**2 + Y**2)),
            "depth-for-distance": Step(d, Z),
        },
    )
