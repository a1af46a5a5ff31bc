"""A quadratic as a product."""

from sympy import symbols

from quizgen.maths.model import Model, Step

a, b, c, x = symbols("a b c x")
MODEL = Model(
    given={a: "", b: "", c: ""},
    free=("x",),
    steps=(
        Step("p", a * x**2 + a * (b + c) * x + a * b * c),
        Step("P", a * (x + b) * (x + c)),
    ),
    traps={
        "signs": Step("P", a * (x - b) * (x - c)),
        "factor-lost": Step("P", (x + b) * (x + c)),
    },
)
