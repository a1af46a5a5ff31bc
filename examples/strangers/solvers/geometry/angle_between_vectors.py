"""The angle between two vectors of the plane."""

from sympy import acos, evaluate, pi, sqrt, symbols

from quizgen.maths.model import Model, Step

a, b, p, q, s, c, phi = symbols("a b p q s c phi")
with evaluate(False):
    MODEL = Model(
        given={a: "", b: "", p: "", q: ""},
        steps=(
            Step(s, a * p + b * q),
            Step(c, s / (sqrt(a**2 + b**2) * sqrt(p**2 + q**2))),
            Step(phi, 180 / pi * acos(c), "°"),
        ),
        traps={
            "minus": Step(s, a * p - b * q),
            "crosswise": Step(s, a * q + b * p),
            "supplement": Step(phi, 180 - 180 / pi * acos(c), "°"),
        },
    )
