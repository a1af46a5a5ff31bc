"""Changing the aperture: hole, blur disc, light and the exposure time that makes up for it.

Source: Hecht, Optics, 5th ed. (2017), section 5.3.3: the f-number, image-plane flux ~ (D/f)^2.
"""

from sympy import Piecewise, evaluate, log, symbols

from quizgen.maths.model import Model, Step

f, N_1, N_2, r = symbols("f N_1 N_2 r", positive=True)
D_1, D_2, q, e, k, t_1, t_2 = symbols("D_1 D_2 q e k t_1 t_2", positive=True)

with evaluate(False):
    MODEL = Model(
        given={f: "mm", N_1: "", N_2: "", r: ""},
        steps=(
            Step(D_1, f / N_1, "mm"),
            Step(D_2, f / N_2, "mm"),
            Step(q, Piecewise((D_1 / D_2, D_1 > D_2), (D_2 / D_1, True))),
            Step(e, q**2),
            Step(k, log(e, 2)),
            Step(t_1, 1 / r, "s"),
            Step(t_2, Piecewise((t_1 * q**2, D_1 > D_2), (t_1 / q**2, True)), "s"),
        ),
        formulas={"D_1": "F31", "D_2": "F31", "e": "F32", "k": "F34", "t_2": "F35"},
        alternatives=(
            Step(t_2, Piecewise((t_1 * e, D_1 > D_2), (t_1 / e, True))),
            Step(t_2, Piecewise((t_1 * 2**k, D_1 > D_2), (t_1 / 2**k, True))),
        ),
        traps={
            "radius": (Step(D_1, f / N_1 / 2), Step(D_2, f / N_2 / 2)),
            "multiplied": (Step(D_1, f * N_1), Step(D_2, f * N_2)),
            "exchanged": (Step(D_1, f / N_2), Step(D_2, f / N_1)),
            "squared": Step(q, Piecewise((D_1 / D_2, D_1 > D_2), (D_2 / D_1, True)) ** 2),
            "numbers-subtracted": Step(q, Piecewise((N_2 - N_1, D_1 > D_2), (N_1 - N_2, True))),
            "upside-down": Step(q, Piecewise((D_2 / D_1, D_1 > D_2), (D_1 / D_2, True))),
            "not-squared": Step(e, q),
            "light-upside-down": Step(e, 1 / q**2),
            "stops-for-factor": Step(e, 2 * log(q, 2)),
            "doubled": Step(e, 2 * q),
            "stops-of-diameter": Step(k, log(q, 2)),
            "factor-for-stops": Step(k, q),
            "light-for-stops": Step(k, e),
            "time-not-squared": Step(t_2, Piecewise((t_1 * q, D_1 > D_2), (t_1 / q, True))),
            "time-wrong-way": Step(t_2, Piecewise((t_1 / q**2, D_1 > D_2), (t_1 * q**2, True))),
            "time-unchanged": Step(t_2, t_1),
        },
    )
