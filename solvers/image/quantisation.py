"""Quantising an intensity from [0, 1] to b bits: step, level, error.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 2.4.
"""

from sympy import evaluate, floor, symbols

from quizgen.maths.model import Model, Step

b, x = symbols("b x", real=True)
n, step, k, q, error, worst = symbols("n Delta k q e e_max", real=True)

with evaluate(False):
    MODEL = Model(
        given={b: "", x: ""},
        steps=(
            Step(n, 2**b),
            Step(step, 1 / (n - 1)),
            Step(k, floor(x / step + 1 / 2)),
            Step(q, k * step),
            Step(error, q - x),
            Step(worst, step / 2),
        ),
        formulas={"n": "F01"},
        alternatives=(
            Step(k, floor(x * (n - 1) + 1 / 2)),
            Step(worst, 1 / (2 * (n - 1))),
        ),
        traps={
            "too-few-levels": Step(n, 2**b - 1),
            "bits-times-two": Step(n, 2 * b),
            "levels-for-gaps": Step(step, 1 / n),
            "truncated": Step(k, floor(x / step)),
            "times-levels": Step(k, floor(x * n)),
            "level-for-value": Step(q, k),
            "whole-step": Step(worst, step),
            "quarter-step": Step(worst, step / 4),
        },
    )
