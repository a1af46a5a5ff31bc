"""Veiling glare: a share of all light lies evenly over the picture and eats contrast.

Source: ISO 9358 (1994), veiling glare index: stray light as a share of the mean.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

a, b, w, q = symbols("a b w q", positive=True)
m, a_2, b_2, C = symbols("m a_2 b_2 C", real=True)

with evaluate(False):
    MODEL = Model(
        given={a: "", b: "", w: "%", q: "%"},
        steps=(
            Step(m, w * a + (1 - w) * b),
            Step(b_2, (1 - q) * b + q * m),
            Step(a_2, (1 - q) * a + q * m),
            Step(C, a_2 / b_2),
        ),
        traps={
            "middle": Step(m, (a + b) / 2),
            "shares-swapped": Step(m, (1 - w) * a + w * b),
            "only-white": Step(m, w * a),
            "of-white": Step(b_2, (1 - q) * b + q * a),
            "mean-alone": Step(b_2, q * m),
            "only-taken": Step(b_2, (1 - q) * b),
            "without-glare": Step(C, a / b),
            "upside-down": Step(C, b_2 / a_2),
        },
    )
