"""The product and the modulus of complex numbers."""

from sympy import Abs, I, symbols

from quizgen.maths.model import Model, Step

a, b, c, d, r = symbols("a b c d r")
MODEL = Model(
    given={a: "", b: "", c: "", d: ""},
    steps=(
        Step("z", a + b * I),
        Step("w", c + d * I),
        Step("u", (a + b * I) * (c + d * I)),
        Step(r, Abs(a + b * I)),
    ),
    traps={
        "parts": Step("u", a * c + b * d * I),
        "sign": Step("u", a * c + b * d + (a * d + b * c) * I),
    },
)
