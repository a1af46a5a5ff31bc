"""Exact values of trigonometric functions at special angles."""

from sympy import I, asin, cos, pi, sin, symbols

from quizgen.maths.model import Model, Step

r, n, d, m, C, S, theta = symbols("r n d m C S theta")
u = n * pi / d
MODEL = Model(
    given={r: "", n: "", d: "", m: ""},
    steps=(
        Step(C, r * cos(u)),
        Step(S, r * sin(u)),
        Step("z", r * cos(u) + I * r * sin(u)),
        Step(theta, asin(sin(m * pi / 12))),
    ),
    traps={
        "sine": Step(C, r * sin(u)),
        "cosine": Step(S, r * cos(u)),
        "swapped": Step("z", r * sin(u) + I * r * cos(u)),
        "other-angle": Step(theta, pi / 2 - m * pi / 12),
    },
)
