"""Field of view of a camera, across and along the diagonal, and the width it covers at a distance.

Source: R. Szeliski, Computer Vision, 2nd ed. (2022), section 2.1.4, eq. 2.60:
tan(theta/2) = W/(2 f).
"""

from sympy import atan, evaluate, pi, sqrt, symbols, tan

from quizgen.maths.model import Model, Step

W, H, f, Z = symbols("W H f Z", positive=True)
alpha, D, delta, w = symbols("alpha D delta w", real=True)

with evaluate(False):
    MODEL = Model(
        given={W: "mm", H: "mm", f: "mm", Z: "m"},
        steps=(
            Step(alpha, 2 * (180 / pi) * atan(W / (2 * f)), "deg"),
            Step(D, sqrt(W**2 + H**2), "mm"),
            Step(delta, 2 * (180 / pi) * atan(D / (2 * f)), "deg"),
            Step(w, Z * W / f, "m"),
        ),
        formulas={"w": "F10"},
        alternatives=(
            Step(delta, 2 * (180 / pi) * atan(tan(pi / 360 * alpha) * D / W)),
            Step(w, 2 * Z * tan(pi / 360 * alpha)),
        ),
        traps={
            "whole-width": (
                Step(alpha, 180 / pi * atan(W / f)),
                Step(delta, 180 / pi * atan(D / f)),
            ),
            "half-angle": (
                Step(alpha, 180 / pi * atan(W / (2 * f))),
                Step(delta, 180 / pi * atan(D / (2 * f))),
            ),
            "twice-the-whole": (
                Step(alpha, 2 * (180 / pi) * atan(W / f)),
                Step(delta, 2 * (180 / pi) * atan(D / f)),
            ),
            "radians": (Step(alpha, 2 * atan(W / (2 * f))), Step(delta, 2 * atan(D / (2 * f)))),
            "upside-down": (
                Step(alpha, 2 * (180 / pi) * atan(2 * f / W)),
                Step(delta, 2 * (180 / pi) * atan(2 * f / D)),
            ),
            "height-for-width": Step(alpha, 2 * (180 / pi) * atan(H / (2 * f))),
            "sides-added": Step(D, W + H),
            "angles-added": Step(delta, alpha + 2 * (180 / pi) * atan(H / (2 * f))),
            "half-the-wall": Step(w, Z * W / (2 * f)),
            "focal-length-multiplies": Step(w, Z * f / W),
        },
    )
