"""Two laser beams compared by luminous flux.

Source: CIE 018:2019, The Basis of Physical Photometry (V of 1924).
"""

from sympy import Eq, Piecewise, Rational, evaluate, symbols

from quizgen.maths.model import Model, Step

P_1, P_2, V_1, V_2 = symbols("P_1 P_2 V_1 V_2", positive=True)
r, Q = symbols("r Q", real=True)
V_700 = Rational(41, 10000)
NOTES = Rational(4, 100)
"""What the lecture notes take for V at 700 nm."""

with evaluate(False):
    MODEL = Model(
        given={P_1: "mW", P_2: "mW", V_1: "", V_2: ""},
        steps=(
            Step(r, (P_1 * V_1) / (P_2 * V_2)),
            Step(Q, P_1 * (V_1 / V_2), "mW"),
        ),
        formulas={"r": "F03", "Q": "F03"},
        alternatives=(Step(Q, r * P_2),),
        traps={
            "only-power": Step(r, P_1 / P_2),
            "only-luminosity": Step(r, V_1 / V_2),
            "of-the-notes": Step(
                r,
                Piecewise(
                    ((P_1 * V_1) / (P_2 * NOTES), Eq(V_2, V_700)),
                    ((P_1 * V_1) / (P_2 * V_2), True),
                ),
            ),
            "inverted": Step(r, (P_2 * V_2) / (P_1 * V_1)),
            "luminosity-inverted": Step(Q, P_1 * (V_2 / V_1)),
            "times-ratio": Step(Q, P_1 * r),
        },
    )
