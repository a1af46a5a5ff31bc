"""Multiplications that a filter of n times n weights takes, in one pass and in two.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 3.4, equation 3-42.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

n, a, M = symbols("n a M", positive=True)
d, s, v, D = symbols("d s v D", positive=True)

with evaluate(False):
    MODEL = Model(
        given={n: "", a: "op/px", M: "px"},
        steps=(
            Step(d, a * n**2, "op/px"),
            Step(s, a * 2 * n, "op/px"),
            Step(v, d / s),
            Step(D, M * (d - s), "Mop"),
        ),
        traps={
            "one-pass": Step(s, a * n),
            "weights-added": Step(d, a * 2 * n),
            "upside-down": Step(v, s / d),
            "difference": Step(v, (d - s) / a),
            "two-passes-only": Step(D, M * s),
            "one-pass-only": Step(D, M * d),
        },
    )
