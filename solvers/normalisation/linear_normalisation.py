"""Linear normalisation of an intensity from one range to another, without clamping.

Source: Burger & Burge, Digital Image Processing, 2nd ed. (2016), section 4.4, eq. 4.9.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

I, I_min, I_max, N_min, N_max = symbols("I I_min I_max N_min N_max", real=True)
d, w, t, N_a, e, N_b = symbols("d w t N_a e N_b", real=True)

with evaluate(False):
    MODEL = Model(
        given={I: "", I_min: "", I_max: "", N_min: "", N_max: ""},
        steps=(
            Step(d, I - I_min),
            Step(w, I_max - I_min),
            Step(t, d / w),
            Step(N_a, t),
            Step(e, (N_max - N_min) * t),
            Step(N_b, e + N_min),
        ),
        formulas={"N_a": "F12", "e": "F11", "N_b": "F11"},
        alternatives=(Step(e, (N_max - N_min) * N_a),),
        traps={
            "one-more": Step(w, I_max - I_min + 1),
            "min-not-subtracted": Step(d, I),
            "divided-by-max": Step(w, I_max),
            "min-ignored": (Step(d, I), Step(w, I_max)),
            "mirrored": Step(d, I_max - I),
            "not-shifted": Step(N_b, e),
            "max-for-width": Step(e, N_max * t),
        },
    )
