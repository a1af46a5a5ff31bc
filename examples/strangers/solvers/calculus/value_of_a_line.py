"""A straight line and its value at a place."""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

m, b, x, y = symbols("m b x y")
with evaluate(False):
    MODEL = Model(
        given={m: "", b: "", x: ""},
        steps=(Step(y, m * x + b),),
        traps={
            "no-intercept": Step(y, m * x),
            "falling": Step(y, -m * x + b),
            "other-axis": Step(y, (x - b) / m),
        },
    )
