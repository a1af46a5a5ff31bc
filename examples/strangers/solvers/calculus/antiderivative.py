"""An antiderivative of a power of a shifted variable."""

from sympy import symbols

from quizgen.maths.model import Model, Step

a, n, x = symbols("a n x")
MODEL = Model(
    given={a: "", n: ""},
    free=("x",),
    steps=(Step("f", (x - a) ** n), Step("F", (x - a) ** (n + 1) / (n + 1))),
    traps={
        "derivative": Step("F", n * (x - a) ** (n - 1)),
        "not-divided": Step("F", (x - a) ** (n + 1)),
    },
)
