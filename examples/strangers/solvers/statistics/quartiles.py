"""The three quartiles of a drawn sample, as R and NumPy have them."""

from sympy import Rational, evaluate, symbols

from quizgen.maths.lists import mean, median, quantile
from quizgen.maths.model import Model, Step

x, q1, q2, q3 = symbols("x q1 q2 q3")
with evaluate(False):
    MODEL = Model(
        given={x: "min"},
        steps=(
            Step(q1, quantile(x, Rational(1, 4)), "min"),
            Step(q2, median(x), "min"),
            Step(q3, quantile(x, Rational(3, 4)), "min"),
        ),
        traps={
            "tenth": Step(q1, quantile(x, Rational(1, 10)), "min"),
            "mean-for-median": Step(q2, mean(x), "min"),
            "ninetieth": Step(q3, quantile(x, Rational(9, 10)), "min"),
        },
    )
