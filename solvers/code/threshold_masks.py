"""Black and white pixels that two threshold masks leave, the white one applied last.

Source: R. C. Gonzalez, R. E. Woods, Digital Image Processing, 4th ed. (2018), section 5.2.
"""

from sympy import Piecewise, evaluate, symbols

from quizgen.maths.model import Model, Step

n, p = symbols("n p", positive=True)
w, b = symbols("w b", real=True)

with evaluate(False):
    MODEL = Model(
        given={n: "", p: ""},
        steps=(
            Step(w, n * (p / 2)),
            Step(b, Piecewise((n * (p / 2), p <= 1), (n * (1 - p / 2), True))),
        ),
        formulas={"w": "F38", "b": "F38"},
        traps={
            "share-each": (Step(w, n * p), Step(b, n * p)),
            "overlap-ignored": Step(b, n * (p / 2)),
            "exchanged": (
                Step(w, Piecewise((n * (p / 2), p <= 1), (n * (1 - p / 2), True))),
                Step(b, n * (p / 2)),
            ),
        },
    )
