"""Two narrow-band lamps compared by what the eye makes of them by day and by night.

Source: CIE 018:2019, The Basis of Physical Photometry (V of 1924, V' of 1951).
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

P_1, P_2, V_1, V_2, N_1, N_2 = symbols("P_1 P_2 V_1 V_2 V'_1 V'_2", positive=True)
day, night = symbols("r_d r_n", positive=True)

with evaluate(False):
    MODEL = Model(
        given={P_1: "mW", P_2: "mW", V_1: "", V_2: "", N_1: "", N_2: ""},
        steps=(
            Step(day, (P_1 * V_1) / (P_2 * V_2)),
            Step(night, (P_1 * N_1) / (P_2 * N_2)),
        ),
        formulas={"r_d": "F03", "r_n": "F03"},
        traps={
            "only-power": (Step(day, P_1 / P_2), Step(night, P_1 / P_2)),
            "only-height": (Step(day, V_1 / V_2), Step(night, N_1 / N_2)),
            "curves-exchanged": (
                Step(day, (P_1 * N_1) / (P_2 * N_2)),
                Step(night, (P_1 * V_1) / (P_2 * V_2)),
            ),
            "inverted": (
                Step(day, (P_2 * V_2) / (P_1 * V_1)),
                Step(night, (P_2 * N_2) / (P_1 * N_1)),
            ),
            "same-by-night": Step(night, day),
        },
    )
