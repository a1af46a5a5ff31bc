"""The matrix of a rotation of the plane."""

from sympy import Matrix, cos, pi, sin, symbols

from quizgen.maths.model import Model, Step

k = symbols("k")
u = k * pi / 12
MODEL = Model(
    given={k: ""},
    steps=(Step("R", Matrix([[cos(u), -sin(u)], [sin(u), cos(u)]])),),
    traps={
        "clockwise": Step("R", Matrix([[cos(u), sin(u)], [-sin(u), cos(u)]])),
        "reflection": Step("R", Matrix([[cos(u), sin(u)], [sin(u), -cos(u)]])),
        "swapped": Step("R", Matrix([[sin(u), -cos(u)], [cos(u), sin(u)]])),
    },
)
