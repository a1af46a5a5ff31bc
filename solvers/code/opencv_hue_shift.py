"""Shift of OpenCV's 8-bit hue: half the angle, modulo 180, computed in a wider type.

Source: OpenCV documentation, "Color conversions"; Python reference, floor division.
"""

from sympy import Mod, evaluate, floor, symbols

from quizgen.maths.model import Model, Step

h, d = symbols("h d", integer=True)
o, c = symbols("o c", integer=True)

with evaluate(False):
    MODEL = Model(
        given={h: "", d: ""},
        steps=(Step(o, floor(d / 2)), Step(c, Mod(h + o, 180))),
        formulas={"o": "F37"},
        traps={
            "offset-in-degrees": Step(o, d),
            "not-wrapped": Step(c, h + o),
            "wrapped-at-360": Step(c, Mod(h + d, 360)),
            "toward-zero": Step(o, floor((d + 1) / 2)),
        },
    )
