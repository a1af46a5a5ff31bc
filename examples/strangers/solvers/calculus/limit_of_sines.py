"""The limit of a quotient of sines at 0."""

from sympy import Symbol, limit, sin, symbols

from quizgen.maths.model import Model, Step

a, b, L = symbols("a b L", positive=True)
x = Symbol("x")
MODEL = Model(
    given={a: "", b: ""},
    steps=(Step(L, limit(sin(a * x) / sin(b * x), x, 0)),),
    traps={"upside-down": Step(L, b / a), "cancelled": Step(L, a / a)},
)
