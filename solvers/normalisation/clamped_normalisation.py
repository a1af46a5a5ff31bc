"""Normalisation to [0, 1] with a two-sided clamp for values outside the nominal range.

Source: Burger & Burge, Digital Image Processing, 2nd ed. (2016), sections 4.1.2 and 4.4.
"""

from sympy import Piecewise, evaluate, floor, symbols

from quizgen.maths.model import Model, Step

I, I_min, I_max = symbols("I I_min I_max", real=True)
d, w, t, N_c = symbols("d w t N_c", real=True)

with evaluate(False):
    MODEL = Model(
        given={I: "", I_min: "", I_max: ""},
        steps=(
            Step(d, I - I_min),
            Step(w, I_max - I_min),
            Step(t, d / w),
            Step(N_c, Piecewise((0, t < 0), (1, t > 1), (t, True))),
        ),
        formulas={"t": "F12", "N_c": "F13"},
        traps={
            "min-not-subtracted": Step(d, I),
            "divided-by-max": Step(w, I_max),
            "min-ignored": (Step(d, I), Step(w, I_max)),
            "mirrored": Step(d, I_max - I),
            "not-clamped": Step(N_c, t),
            "wrapped": Step(N_c, t - floor(t)),
            "wrong-end": Step(N_c, Piecewise((1, t < 0), (0, t > 1), (1 - t, True))),
            "clamped-inside": Step(N_c, Piecewise((0, t < 1 / 2), (1, True))),
        },
    )
