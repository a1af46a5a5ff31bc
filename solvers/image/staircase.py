"""A quantiser read from its staircase: bits, code and value of an intensity, largest error.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 2.4.
"""

from sympy import evaluate, floor, log, sqrt, symbols

from quizgen.maths.model import Model, Step

n, c, d, h, x = symbols("n c d h I", positive=True)
b, k, q, worst = symbols("b k q e_max", real=True)

with evaluate(False):
    MODEL = Model(
        given={n: "", c: "", d: "", h: "", x: ""},
        steps=(
            Step(b, log(n, 2)),
            Step(k, floor(c * x + d)),
            Step(q, k / (n - 1)),
            Step(worst, h / c),
        ),
        formulas={"b": "F01"},
        alternatives=(Step(q, k / (2**b - 1)),),
        traps={
            "levels-for-bits": Step(b, n),
            "halved": Step(b, n / 2),
            "nearest-instead": Step(k, floor((n - 1) * x + 1 / 2)),
            "down-instead": Step(k, floor((n - 1) * x)),
            "next-step": Step(k, floor(c * x + d) + 1),
            "divided-by-levels": Step(q, k / n),
            "code-for-value": Step(q, k),
            "half-step-instead": Step(worst, 1 / (2 * (n - 1))),
            "whole-step-instead": Step(worst, 1 / (n - 1)),
            "root-of-twelve": Step(worst, 1 / (sqrt(12) * (n - 1))),
        },
    )
