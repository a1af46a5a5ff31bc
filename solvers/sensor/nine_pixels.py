"""Noise, signal-to-noise ratio and gain from a few pixels of an evenly lit area.

Source: EMVA Standard 1288, release 4.0 (2021), section 2: variance above that of the dark over
mean above the dark level is the gain.
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.lists import mean, pvar, var
from quizgen.maths.model import Model, Step

x, b, v_d = symbols("x b v_d", positive=True)
m, v, s, S, Q, K = symbols("m v s S Q K", real=True)

with evaluate(False):
    MODEL = Model(
        given={x: "", b: "", v_d: ""},
        steps=(
            Step(m, mean(x)),
            Step(v, var(x)),
            Step(s, sqrt(v)),
            Step(S, m - b),
            Step(Q, S / s),
            Step(K, (v - v_d) / S),
        ),
        traps={
            "by-n": Step(v, pvar(x)),
            "variance-for-deviation": Step(s, v),
            "dark-level-left": Step(S, m),
            "dark-level-added": Step(S, m + b),
            "by-variance": Step(Q, S / v),
            "dark-noise-left": Step(K, v / S),
            "upside-down": Step(K, S / (v - v_d)),
        },
    )
