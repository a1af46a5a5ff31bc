"""A camera matrix whose pixels have their centres at whole numbers, cropped and resized.

The corner of the picture lies at -1/2, so a picture is resized about that corner, not about the
origin. Source: R. Szeliski, Computer Vision, 2nd ed. (2022), section 2.1.4.
"""

from sympy import Rational, evaluate, symbols

from quizgen.maths.model import Model, Step

HALF = Rational(1, 2)
f, o_x, o_y, x_0, y_0, k = symbols("f o_x o_y x_0 y_0 k", positive=True)
u_c, v_c, f_r, u_r, v_r, u_k, v_k = symbols("u_c v_c f_r u_r v_r u_k v_k", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "px", o_x: "px", o_y: "px", x_0: "px", y_0: "px", k: ""},
        steps=(
            Step(u_c, o_x - x_0, "px"),
            Step(v_c, o_y - y_0, "px"),
            Step(f_r, k * f, "px"),
            Step(u_r, k * (u_c + HALF) - HALF, "px"),
            Step(v_r, k * (v_c + HALF) - HALF, "px"),
            Step(u_k, u_r + HALF, "px"),
            Step(v_k, v_r + HALF, "px"),
        ),
        traps={
            "added": (Step(u_c, o_x + x_0), Step(v_c, o_y + y_0)),
            "not-cropped": (Step(u_c, o_x), Step(v_c, o_y)),
            "same-focal-length": Step(f_r, f),
            "divided": Step(f_r, f / k),
            "about-the-origin": (Step(u_r, k * u_c), Step(v_r, k * v_c)),
            "half-not-returned": (Step(u_r, k * (u_c + HALF)), Step(v_r, k * (v_c + HALF))),
            "other-way": (Step(u_k, u_r - HALF), Step(v_k, v_r - HALF)),
            "origin-stays": (Step(u_k, u_r), Step(v_k, v_r)),
        },
    )
