"""Mean of 3 x 3 pixels in the upper left corner of a picture, for two ways to go on beyond it.

Source: Szeliski, Computer Vision, 2nd ed. (2022), section 3.2, "Padding".
"""

from sympy import Add, evaluate, symbols

from quizgen.maths.model import Model, Step

a, b, c, d = symbols("a b c d", integer=True)
s, z, t, r = symbols("s z t r", real=True)

with evaluate(False):
    MODEL = Model(
        given={a: "", b: "", c: "", d: ""},
        steps=(
            Step(s, Add(a, b, c, d)),
            Step(z, s / 9),
            Step(t, Add(4 * a, 2 * b, 2 * c, d)),
            Step(r, t / 9),
        ),
        traps={
            "inside-only": Step(z, s / 4),
            "corner-alone": Step(z, a / 9),
            "not-divided": (Step(z, s), Step(r, t)),
            "mirrored": Step(t, Add(a, 2 * b, 2 * c, 4 * d)),
            "zeros-again": Step(t, Add(a, b, c, d)),
            "corner-everywhere": Step(t, Add(6 * a, b, c, d)),
        },
    )
