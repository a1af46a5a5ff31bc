"""Averaging two intensities before and after a power-law encoding.

Source: C. Poynton, Digital Video and HD, 2nd ed. (2012), chapter 27.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

a, b, gamma = symbols("a b gamma", positive=True)
m, E_1, e_a, e_b, E_2, L = symbols("m E_1 e_a e_b E_2 L", real=True)

with evaluate(False):
    MODEL = Model(
        given={a: "", b: "", gamma: ""},
        steps=(
            Step(m, (a + b) / 2),
            Step(E_1, m ** (1 / gamma)),
            Step(e_a, a ** (1 / gamma)),
            Step(e_b, b ** (1 / gamma)),
            Step(E_2, (e_a + e_b) / 2),
            Step(L, E_2**gamma),
        ),
        formulas={"E_1": "F46", "e_a": "F46", "e_b": "F46", "L": "F46"},
        traps={
            "exponent-inverted": (
                Step(E_1, m**gamma),
                Step(e_a, a**gamma),
                Step(e_b, b**gamma),
                Step(L, E_2 ** (1 / gamma)),
            ),
            "exchanged": (
                Step(E_1, (a ** (1 / gamma) + b ** (1 / gamma)) / 2),
                Step(E_2, m ** (1 / gamma)),
            ),
            "not-encoded-again": Step(E_1, m),
            "not-averaged": Step(E_2, e_a + e_b),
            "encoded-twice": Step(L, E_2 ** (1 / gamma)),
            "not-decoded": Step(L, E_2),
        },
    )
