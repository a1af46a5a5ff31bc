"""Pixels left after erosion, dilation, opening and closing by 3 x 3 pixels.

A rectangle of m times n pixels and k single ones, all far from each other and from the border.
Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), sections 9.2 and 9.3.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

m, n, k = symbols("m n k", integer=True)
E, D, O = symbols("E D O", integer=True)

with evaluate(False):
    MODEL = Model(
        given={m: "", n: "", k: ""},
        steps=(
            Step(E, (m - 2) * (n - 2)),
            Step(D, (m + 2) * (n + 2) + 9 * k),
            Step(O, m * n),
        ),
        traps={
            "one-side": (Step(E, (m - 1) * (n - 1)), Step(D, (m + 1) * (n + 1) + 4 * k)),
            "four-neighbours": Step(D, m * n + 2 * m + 2 * n + 5 * k),
            "dots-stay": (Step(E, (m - 2) * (n - 2) + k), Step(O, m * n + k)),
            "dots-forgotten": Step(D, (m + 2) * (n + 2)),
            "dots-not-grown": Step(D, (m + 2) * (n + 2) + k),
            "only-eroded": Step(O, (m - 2) * (n - 2)),
        },
    )
