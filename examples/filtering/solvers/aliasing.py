"""Frequency that stripes seem to have once they are sampled.

Source: Szeliski, Computer Vision, 2nd ed. (2022), section 2.3.
"""

from sympy import Abs, Rational, evaluate, floor, symbols

from quizgen.maths.model import Model, Step

f, p, w = symbols("f p f_s", positive=True)
q, u, k, a = symbols("f_N u k u_a", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "cycle/mm", p: "um/px", w: "cycle/px"},
        steps=(
            Step(q, w / (2 * p), "cycle/mm"),
            Step(u, f * p, "cycle/px"),
            Step(k, floor(u / w + Rational(1, 2))),
            Step(a, Abs(u - k * w), "cycle/px"),
        ),
        traps={
            "sampling-frequency": Step(q, w / p),
            "pitch-doubled-back": Step(q, 2 * w / p),
            "not-sampled": Step(a, u),
            "above-nyquist": Step(a, Abs(u - w / 2)),
            "to-the-first": Step(a, Abs(u - w)),
            "not-folded": Step(a, u - w * floor(u / w)),
        },
    )
