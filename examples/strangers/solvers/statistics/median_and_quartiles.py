"""Median, quartiles and interquartile range of a drawn sample."""

from sympy import Rational, evaluate, symbols

from quizgen.maths.lists import max, mean, median, min, quantile
from quizgen.maths.model import Model, Step

x, e, l, q, d = symbols("x e l q d")
with evaluate(False):
    MODEL = Model(
        given={x: "g"},
        steps=(
            Step(e, median(x), "g"),
            Step(l, quantile(x, Rational(1, 4)), "g"),
            Step(q, quantile(x, Rational(3, 4)), "g"),
            Step(d, q - l, "g"),
        ),
        traps={
            "mean-for-median": Step(e, mean(x), "g"),
            "least": Step(l, min(x), "g"),
            "largest": Step(q, max(x), "g"),
            "half": Step(d, (q - l) / 2, "g"),
        },
    )
