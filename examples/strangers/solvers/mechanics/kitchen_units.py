"""Cups and miles per hour in metric units."""

from sympy import Rational, evaluate, symbols

from quizgen.maths.model import Model, Step

n, v, V, w = symbols("n v V w")
MILE, CUP = Rational("1.609344"), Rational("236.5882365")
with evaluate(False):
    MODEL = Model(
        given={n: "cup", v: "mi/h"},
        steps=(Step(V, 1 * n, "ml"), Step(w, 1 * v, "km/h")),
        traps={
            "metric-cup": Step(V, n * 250 / CUP, "ml"),
            "upside-down": Step(w, v / MILE**2, "km/h"),
        },
    )
