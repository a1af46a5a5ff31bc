"""How far and at which angle something upright leans under a rolling shutter.

Source: R. Szeliski, Computer Vision, 2nd ed. (2022), section 2.3; plain kinematics.
"""

from sympy import atan, evaluate, pi, symbols

from quizgen.maths.model import Model, Step

v, t_r, n, t = symbols("v t_r n t", positive=True)
T, d, alpha = symbols("T d alpha", real=True)

with evaluate(False):
    MODEL = Model(
        given={v: "px/s", t_r: "us", n: "", t: "ms"},
        steps=(
            Step(T, n * t_r, "ms"),
            Step(d, v * T, "px"),
            Step(alpha, 180 / pi * atan(d / n), "deg"),
        ),
        traps={
            "exposure-for-read-out": Step(d, v * t),
            "both-times": Step(d, v * (T + t)),
            "one-row": Step(d, v * t_r),
            "speed-divides": Step(d, T / v * 1000000),
            "radians": Step(alpha, atan(d / n)),
            "from-the-rows": Step(alpha, 90 - 180 / pi * atan(d / n)),
            "half-angle": Step(alpha, 180 / pi * atan(d / (2 * n))),
        },
    )
