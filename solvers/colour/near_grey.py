"""Hue of a colour that differs from a grey by a few ten-millionths, and how it is lost.

Source: A. R. Smith, "Color gamut transform pairs", SIGGRAPH 1978.
"""

from sympy import Integer, evaluate, symbols

from quizgen.maths.model import Model, Step

B, u, v = symbols("B u v", positive=True)
s, H, R, G, F = symbols("s H R G F", real=True)
SMALL = Integer(10) ** 7

with evaluate(False):
    MODEL = Model(
        given={B: "", u: "", v: ""},
        steps=(
            Step(s, v / u),
            Step(H, 60 * s, "deg"),
            Step(R, B + u / SMALL),
            Step(G, B + v / SMALL),
            Step(F, 60 * ((G - B) / (R - B)), "deg"),
        ),
        formulas={"H": "F24", "F": "F24"},
        traps={
            "over-value": Step(s, v / SMALL / (B + u / SMALL)),
            "next-branch": Step(H, 60 * (2 + s)),
            "swapped": Step(H, -60 * s),
            "distance-to-red": Step(s, (u - v) / u),
        },
    )
