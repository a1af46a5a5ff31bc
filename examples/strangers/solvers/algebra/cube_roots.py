"""The three cube roots of a complex number, by modulus and arguments."""

from sympy import FiniteSet, I, cos, pi, sin, symbols

from quizgen.maths.model import Model, Step

r, k, R, phi = symbols("r k R phi")
u = k * pi / 12
MODEL = Model(
    given={r: "", k: ""},
    steps=(
        Step("w", r**3 * (cos(3 * u) + I * sin(3 * u))),
        Step(R, r),
        Step("T", FiniteSet(u, u + 2 * pi / 3, u - 2 * pi / 3)),
    ),
    traps={
        "not-rooted": Step(R, r**3),
        "argument-kept": Step("T", FiniteSet(3 * u, 3 * u + 2 * pi / 3, 3 * u - 2 * pi / 3)),
        "quarter-turns": Step("T", FiniteSet(u, u + pi / 2, u - pi / 2)),
    },
)
