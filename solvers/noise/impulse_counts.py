"""Expected numbers of black, white and untouched pixels under salt-and-pepper noise.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 5.2.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

M, p = symbols("M p", positive=True)
N, black, white, rest = symbols("N N_b N_w N_0", positive=True)

with evaluate(False):
    MODEL = Model(
        given={M: "", p: "%"},
        steps=(
            Step(N, M * p),
            Step(black, N / 2),
            Step(white, N / 2),
            Step(rest, M - N),
        ),
        formulas={"N": "F38", "N_b": "F38", "N_w": "F38"},
        traps={
            "share-each": (Step(black, N), Step(white, N), Step(rest, M - 2 * N)),
            "share-each-once": (Step(black, N), Step(white, N)),
            "percent-forgotten": Step(N, 100 * M * p),
            "hit-for-rest": Step(rest, N),
            "fraction-of-rest": (Step(black, N / 2), Step(white, (M - N / 2) * p / 2)),
        },
    )
