"""The composite trapezium rule with four pieces, for one of four functions."""

from sympy import Eq, Function, Piecewise, Rational, cos, exp, log, sqrt, symbols

from quizgen.maths.model import Model, Step

k, p, q, h, T, x = symbols("k p q h T x")
f = Function("f")(x)
ROOT, BELL, PRODUCT, WAVE = sqrt(1 + x**3), exp(-(x**2)), x * log(x), cos(x**2 / 4)


def rule(of_ends, pieces=4):
    """Return the sum over the places of the rule, where its ends have a weight."""
    inner = sum(f.subs(x, p + i * h) for i in range(1, pieces))
    return h * (of_ends * (f.subs(x, p) + f.subs(x, q)) + inner)


MODEL = Model(
    given={k: "", p: "", q: ""},
    free=("x",),
    steps=(
        Step(f, Piecewise((ROOT, Eq(k, 1)), (BELL, Eq(k, 2)), (PRODUCT, Eq(k, 3)), (WAVE, True))),
        Step(h, (q - p) / 4),
        Step(T, rule(of_ends=Rational(1, 2))),
    ),
    traps={
        "whole-ends": Step(T, rule(of_ends=1)),
        "no-ends": Step(T, rule(of_ends=0)),
        "five-pieces": Step(h, (q - p) / 5),
    },
)
