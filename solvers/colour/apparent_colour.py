"""Colour of a reflecting surface in three bands: light times reflectance, band by band.

Source: Burger & Burge, Digital Image Processing, 2nd ed. (2016), section 12.1 (three-band model).
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

L_r, L_g, L_b, R_r, R_g, R_b = symbols("L_r L_g L_b R_r R_g R_b", real=True)
r, g, b = symbols("r g b", real=True)

with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys((L_r, L_g, L_b, R_r, R_g, R_b), ""),
        steps=(Step(r, L_r * R_r), Step(g, L_g * R_g), Step(b, L_b * R_b)),
        formulas={"r": "F02", "g": "F02", "b": "F02"},
        traps={
            "added": (Step(r, L_r + R_r), Step(g, L_g + R_g), Step(b, L_b + R_b)),
            "averaged": (
                Step(r, (L_r + R_r) / 2),
                Step(g, (L_g + R_g) / 2),
                Step(b, (L_b + R_b) / 2),
            ),
            "colour-stays": (Step(r, R_r), Step(g, R_g), Step(b, R_b)),
            "light-only": (Step(r, L_r), Step(g, L_g), Step(b, L_b)),
            "absorbed": (
                Step(r, L_r * (1 - R_r)),
                Step(g, L_g * (1 - R_g)),
                Step(b, L_b * (1 - R_b)),
            ),
        },
    )
