"""Shift of OpenCV's 8-bit hue without a wider type: the sum wraps at 256 first.

Source: NumPy reference, "Data type objects": unsigned integers wrap around.
"""

from sympy import Mod, evaluate, floor, symbols

from quizgen.maths.model import Model, Step

h, d = symbols("h d", integer=True)
o, s, w, c = symbols("o s w c", integer=True)

with evaluate(False):
    MODEL = Model(
        given={h: "", d: ""},
        steps=(
            Step(o, floor(d / 2)),
            Step(s, h + o),
            Step(w, Mod(s, 256)),
            Step(c, Mod(w, 180)),
        ),
        formulas={"w": "F36", "o": "F37"},
        traps={
            "no-wrap": Step(w, s),
            "offset-in-degrees": Step(o, d),
            "not-reduced": Step(c, s),
        },
    )
