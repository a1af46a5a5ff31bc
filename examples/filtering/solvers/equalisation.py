"""Histogram equalisation of a picture with eight grey levels: where level 3 goes.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 3.3.
"""

from sympy import Add, Rational, evaluate, floor, symbols

from quizgen.maths.model import Model, Step

H = symbols("h_0:8", integer=True)
N, C, x, s = symbols("N C x s", real=True)

with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys(H, "px"),
        steps=(
            Step(N, Add(*H), "px"),
            Step(C, Add(*H[:4]), "px"),
            Step(x, 7 * C / N),
            Step(s, floor(x + Rational(1, 2))),
        ),
        traps={
            "own-level-left-out": Step(C, Add(*H[:3])),
            "own-level-alone": Step(C, H[3]),
            "from-above": Step(C, Add(*H[3:])),
            "eight": Step(x, 8 * C / N),
            "cut": Step(s, floor(x)),
        },
    )
