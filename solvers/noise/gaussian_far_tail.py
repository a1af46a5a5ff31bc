"""Share of a normal distribution beyond k standard deviations, and the form that loses it.

Source: Abramowitz & Stegun, Handbook of Mathematical Functions (1964), 7.1.1, 7.1.2, 26.2.29.
"""

from sympy import erf, erfc, evaluate, exp, pi, sqrt, symbols

from quizgen.maths.model import Model, Step

k = symbols("k", positive=True)
a, P, D = symbols("a P D", real=True)

with evaluate(False):
    MODEL = Model(
        given={k: ""},
        steps=(Step(a, k / sqrt(2)), Step(P, erfc(a)), Step(D, 1 - erf(a))),
        formulas={"P": "F18", "D": "F18"},
        traps={
            "one-sided": Step(P, erfc(a) / 2),
            "root-forgotten": Step(a, k),
            "density": Step(P, exp(-(k**2) / 2) / sqrt(2 * pi)),
        },
    )
