"""Metamers in four bands: two reflectances with the same three sensor responses.

Each sensor sums two neighbouring bands, so (1, -1, 1, -1) is invisible under white light.
Source: Wyszecki & Stiles, Color Science, 2nd ed. (1982), section 3.8 (metameric stimuli).
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

a_1, a_2, a_3, a_4, t, l = symbols("a_1 a_2 a_3 a_4 t l", positive=True)
L, M, S = symbols("L M S", positive=True)
A, B, d = symbols("A B d", real=True)

with evaluate(False):
    MODEL = Model(
        given={a_1: "", a_2: "", a_3: "", a_4: "", t: "", l: ""},
        steps=(
            Step(L, a_1 + a_2),
            Step(M, a_2 + a_3),
            Step(S, a_3 + a_4),
            Step(A, l * a_1 + a_2),
            Step(B, l * (a_1 + t) + (a_2 - t)),
            Step(d, B - A),
        ),
        formulas={"L": "F04", "M": "F04", "S": "F04"},
        traps={
            "one-band-each": (Step(L, a_1), Step(M, a_2), Step(S, a_3)),
            "averaged": (
                Step(L, (a_1 + a_2) / 2),
                Step(M, (a_2 + a_3) / 2),
                Step(S, (a_3 + a_4) / 2),
            ),
            "still-equal": Step(d, A - A),
            "second-band-kept": Step(B, l * (a_1 + t) + a_2),
            "lamp-on-both": Step(B, l * (a_1 + t) + l * (a_2 + t)),
        },
    )
