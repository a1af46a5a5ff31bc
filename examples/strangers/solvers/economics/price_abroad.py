"""A price in another currency, by a table of rates."""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

n, p, r, K = symbols("n p r K")
with evaluate(False):
    MODEL = Model(
        given={n: "", p: "", r: ""},
        steps=(Step(K, n * p * r),),
        traps={"divided": Step(K, n * p / r), "one-share": Step(K, p * r)},
    )
