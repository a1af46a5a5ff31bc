"""Aliasing: the limit of a pixel grid, and the pattern that a finer one turns into.

Source: R. C. Gonzalez and R. E. Woods, Digital Image Processing, 4th ed. (2018), section 4.3.
"""

from sympy import Abs, evaluate, symbols

from quizgen.maths.model import Model, Step

p, f = symbols("p f", positive=True)
f_N, f_a, n = symbols("f_N f_a n", positive=True)

with evaluate(False):
    MODEL = Model(
        given={p: "um", f: "lp/mm"},
        steps=(
            Step(f_N, 1 / (2 * p), "lp/mm"),
            Step(f_a, Abs(f - 1 / p), "lp/mm"),
            Step(n, 1 / (f_a * p)),
        ),
        alternatives=(Step(f_a, Abs(f - 2 * f_N)),),
        traps={
            "one-pixel": Step(f_N, 1 / p),
            "above-the-limit": Step(f_a, f - f_N),
            "as-it-is": Step(f_a, f),
            "at-the-limit": Step(f_a, f_N),
            "pixels-inverted": Step(n, f_a * p),
        },
    )
