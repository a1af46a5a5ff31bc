"""A camera matrix after the picture was cropped, resized, and counted from another corner.

Source: R. Hartley and A. Zisserman, Multiple View Geometry, 2nd ed. (2004), section 6.1.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

f, o_x, o_y, x_0, y_0, k, h = symbols("f o_x o_y x_0 y_0 k h", positive=True)
u_c, v_c, f_r, u_r, v_r, v_u = symbols("u_c v_c f_r u_r v_r v_u", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "px", o_x: "px", o_y: "px", x_0: "px", y_0: "px", k: "", h: "px"},
        steps=(
            Step(u_c, o_x - x_0, "px"),
            Step(v_c, o_y - y_0, "px"),
            Step(f_r, k * f, "px"),
            Step(u_r, k * u_c, "px"),
            Step(v_r, k * v_c, "px"),
            Step(v_u, k * h - v_r, "px"),
        ),
        traps={
            "added": (Step(u_c, o_x + x_0), Step(v_c, o_y + y_0)),
            "not-cropped": (Step(u_c, o_x), Step(v_c, o_y)),
            "same-focal-length": Step(f_r, f),
            "divided": (Step(f_r, f / k), Step(u_r, u_c / k), Step(v_r, v_c / k)),
            "point-stays": (Step(u_r, u_c), Step(v_r, v_c)),
            "old-height": Step(v_u, h - v_r),
            "not-turned": Step(v_u, v_r),
        },
    )
