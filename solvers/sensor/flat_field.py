"""Flat-field correction of two pixels with a dark frame.

Source: EMVA Standard 1288, release 4.0; S. B. Howell, Handbook of CCD Astronomy, 2nd ed. (2006),
section 4.5: (raw - dark)/(flat - dark) times the mean of (flat - dark).
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

r_1, r_2, d, f_1, f_2, m = symbols("r_1 r_2 d f_1 f_2 m", positive=True)
g_1, g_2, I_1, I_2, w = symbols("g_1 g_2 I_1 I_2 w", real=True)

with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys((r_1, r_2, d, f_1, f_2, m), ""),
        steps=(
            Step(g_1, m / (f_1 - d)),
            Step(g_2, m / (f_2 - d)),
            Step(I_1, (r_1 - d) * g_1),
            Step(I_2, (r_2 - d) * g_2),
            Step(w, r_2 / f_2 * m),
        ),
        formulas={"I_1": "F39", "I_2": "F39", "w": "F39"},
        traps={
            "dark-left-in": (Step(I_1, r_1 / f_1 * m), Step(I_2, r_2 / f_2 * m)),
            "dark-left-in-flat": (Step(g_1, m / f_1), Step(g_2, m / f_2)),
            "dark-left-in-raw": (Step(I_1, r_1 * g_1), Step(I_2, r_2 * g_2)),
            "multiplied": (Step(g_1, (f_1 - d) / m), Step(g_2, (f_2 - d) / m)),
            "not-scaled-back": (Step(g_1, 1 / (f_1 - d)), Step(g_2, 1 / (f_2 - d))),
            "dark-added-back": (Step(I_1, (r_1 - d) * g_1 + d), Step(I_2, (r_2 - d) * g_2 + d)),
            "dark-taken-off": Step(w, I_2),
            "not-divided": Step(w, r_2 * g_2),
        },
    )
