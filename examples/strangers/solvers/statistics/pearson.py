"""Pearson's correlation and the test whether it is 0."""

from sympy import Function, Rational, evaluate, sqrt, symbols

from quizgen.maths.lists import corr, cov, len, pvar, slope
from quizgen.maths.model import Model, Step

x, y, r, T, c = symbols("x y r T c")
quantile = Function("t_quantile")
with evaluate(False):
    MODEL = Model(
        given={x: "", y: ""},
        steps=(
            Step(r, corr(x, y)),
            Step(T, r * sqrt((len(x) - 2) / (1 - r**2))),
            Step(c, quantile(Rational(39, 40), len(x) - 2)),
        ),
        traps={
            "slope": Step(r, slope(x, y)),
            "mixed": Step(r, cov(x, y) / sqrt(pvar(x) * pvar(y))),
            "all-degrees": Step(T, r * sqrt(len(x) / (1 - r**2))),
            "one-sided": Step(c, quantile(Rational(19, 20), len(x) - 2)),
            "all-free": Step(c, quantile(Rational(39, 40), len(x))),
        },
    )
