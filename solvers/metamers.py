"""Responses of three overlapping cone types to light in four bands, for two reflectances.

Source: G. Wyszecki, W. S. Stiles, Color Science, 2nd ed. (1982), section 3.8 (metamers); the cones
are simplified to two neighbouring bands each, so that (1, -1, 1, -1) changes no response.
"""

from sympy import evaluate, symbols

from quizgen.model import Model, Step

w_1 = symbols("w_1", positive=True)
r_1, r_2, r_3, r_4, t = symbols("r_1 r_2 r_3 r_4 t", real=True)
s_S, s_M, s_L, q_1, q_2, e = symbols("s_S s_M s_L q_1 q_2 e", real=True)

with evaluate(False):
    MODEL = Model(
        given={r_1: "", r_2: "", r_3: "", r_4: "", t: "", w_1: ""},
        steps=(
            Step(s_S, r_1 + r_2),
            Step(s_M, r_2 + r_3),
            Step(s_L, r_3 + r_4),
            Step(q_1, r_1 + t),
            Step(q_2, r_2 - t),
            Step(e, (w_1 * q_1 + q_2) - (w_1 * r_1 + r_2)),
        ),
        traps={
            "multiplied": (Step(s_S, r_1 * r_2), Step(s_M, r_2 * r_3), Step(s_L, r_3 * r_4)),
            "order-reversed": (Step(s_S, r_3 + r_4), Step(s_L, r_1 + r_2)),
            "one-band-each": (Step(s_S, r_1), Step(s_M, r_2 + r_3), Step(s_L, r_4)),
            "still-equal": Step(e, 0 * t),
            "second-band-forgotten": Step(e, w_1 * q_1 - w_1 * r_1),
        },
    )
