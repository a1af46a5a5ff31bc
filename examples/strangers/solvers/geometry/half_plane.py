"""The half plane below the line through two points."""

from sympy import symbols

from quizgen.maths.model import Model, Step

a, b, c, d, x, y = symbols("a b c d x y")
line = b + (d - b) / (c - a) * (x - a)
MODEL = Model(
    given={a: "", b: "", c: "", d: ""},
    free=("x", "y"),
    steps=(Step("H", y < line),),
    traps={
        "above": Step("H", y > line),
        "with-line": Step("H", y <= line),
        "slope-inverted": Step("H", y < b + (c - a) / (d - b) * (x - a)),
    },
)
