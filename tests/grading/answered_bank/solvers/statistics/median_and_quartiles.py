"""Mean, median and quartile of a drawn sample."""

from sympy import Rational, evaluate, symbols

from quizgen.maths.lists import len, mean, median, quantile, sum
from quizgen.maths.model import Model, Step

x, m, e, q = symbols("x m e q")
with evaluate(False):
    MODEL = Model(
        given={x: "g"},
        steps=(
            Step(m, mean(x), "g"),
            Step(e, median(x), "g"),
            Step(q, quantile(x, Rational(3, 4)), "g"),
        ),
        traps={
            "one-less": Step(m, sum(x) / (len(x) - 1), "g"),
            "mean-for-median": Step(e, mean(x), "g"),
            "lower-quartile": Step(q, quantile(x, Rational(1, 4)), "g"),
        },
    )
