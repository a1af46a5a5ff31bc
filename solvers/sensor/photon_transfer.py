"""Gain and read noise of a camera from means and variances of its grey levels.

Source: EMVA Standard 1288, release 4.0 (2021), section 2: the photon transfer curve.
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

mu_1, mu_2, v_1, v_2 = symbols("mu_1 mu_2 v_1 v_2", positive=True)
K, v_0, s_0, r = symbols("K v_0 s_0 r", positive=True)

with evaluate(False):
    dark = Step(v_0, v_1 - (v_2 - v_1) / (mu_2 - mu_1) * mu_1)  # a wrong gain need not spoil it
    MODEL = Model(
        given={mu_1: "", mu_2: "", v_1: "", v_2: ""},
        steps=(
            Step(K, (v_2 - v_1) / (mu_2 - mu_1)),
            Step(v_0, v_1 - K * mu_1),
            Step(s_0, sqrt(v_0)),
            Step(r, s_0 / K),
        ),
        traps={
            "slope-inverted": (Step(K, (mu_2 - mu_1) / (v_2 - v_1)), dark),
            "through-the-origin": (Step(K, v_1 / mu_1), dark),
            "variance-as-noise": Step(s_0, v_0),
            "not-converted": Step(r, s_0),
        },
    )
