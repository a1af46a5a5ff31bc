"""Hue of an 8-bit colour as OpenCV stores it: half the angle.

Source: OpenCV documentation, "Color conversions", RGB to HSV for 8-bit images.
"""

from sympy import Eq, Max, Min, Piecewise, Rational, evaluate, floor, symbols

from quizgen.maths.model import Model, Step

R, G, B = symbols("R G B", real=True)
V, m, Delta, H_0, H = symbols("V m Delta H_0 H", real=True)
c = symbols("c", integer=True)

with evaluate(False):
    MODEL = Model(
        given={R: "", G: "", B: ""},
        steps=(
            Step(V, Max(R, G, B)),
            Step(m, Min(R, G, B)),
            Step(Delta, V - m),
            Step(
                H_0,
                Piecewise(
                    (60 * ((G - B) / Delta), Eq(V, R)),
                    (60 * (2 + (B - R) / Delta), Eq(V, G)),
                    (60 * (4 + (R - G) / Delta), True),
                ),
                "deg",
            ),
            Step(H, Piecewise((H_0 + 360, H_0 < 0), (H_0, True)), "deg"),
            Step(c, H / 2),
        ),
        formulas={"V": "F23", "Delta": "F23", "H_0": "F24", "c": "F37"},
        traps={
            "degrees": Step(c, H),
            "full-range": Step(c, floor(H * 256 / 360 + Rational(1, 2))),
            "channels-exchanged": Step(
                H_0,
                Piecewise(
                    (60 * ((G - R) / Delta), Eq(V, B)),
                    (60 * (2 + (R - B) / Delta), Eq(V, G)),
                    (60 * (4 + (B - G) / Delta), True),
                ),
            ),
        },
    )
