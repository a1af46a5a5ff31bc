"""Connected components of five pixels in a row whose gaps are open, bridged or filled.

A bridge is a pixel above or below the gap: it touches both sides, but at corners only.
Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 2.5.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

a, b = symbols("a b", integer=True)
p, n_4, n_8 = symbols("p n_4 n_8", integer=True)

with evaluate(False):
    MODEL = Model(
        given={a: "", b: ""},
        steps=(Step(p, 5 + a + b), Step(n_4, p - 2 * a), Step(n_8, n_4 - 2 * b)),
        traps={
            "exchanged": (Step(n_4, p - 2 * a - 2 * b), Step(n_8, p - 2 * a)),
            "corners-always": Step(n_4, p - 2 * a - 2 * b),
            "corners-never": Step(n_8, n_4),
            "pixels": (Step(n_4, p), Step(n_8, p)),
            "bridges-alone": Step(n_8, n_4 - b),
        },
    )
