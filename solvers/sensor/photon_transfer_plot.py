"""Gain, read noise and full well of a camera, read off its photon transfer curve.

Source: EMVA Standard 1288, release 4.0 (2021), section 2; J. R. Janesick, Photon Transfer (2007).
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

v_0, v_s, mu_s = symbols("v_0 v_s mu_s", positive=True)
K, s_0, r, n = symbols("K s_0 r n_s", positive=True)

with evaluate(False):
    MODEL = Model(
        given={v_0: "", v_s: "", mu_s: ""},
        steps=(
            Step(K, (v_s - v_0) / mu_s),
            Step(s_0, sqrt(v_0)),
            Step(r, s_0 / K),
            Step(n, mu_s / K),
        ),
        traps={
            "slope-inverted": Step(K, mu_s / (v_s - v_0)),
            "through-the-origin": Step(K, v_s / mu_s),
            "variance-as-noise": Step(s_0, v_0),
            "not-converted": Step(r, s_0),
            "levels-for-electrons": Step(n, mu_s),
        },
    )
