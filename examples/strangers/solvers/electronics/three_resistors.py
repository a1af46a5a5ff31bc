"""Three resistors in series or parallel."""

from sympy import Eq, Piecewise, evaluate, symbols

from quizgen.maths.model import Model, Step

k, U, A, B, C, R, I = symbols("k U R_1 R_2 R_3 R I")
with evaluate(False):
    row, parallel = A + B + C, 1 / (1 / A + 1 / B + 1 / C)
MODEL = Model(
    given={k: "", U: "V", A: "ohm", B: "ohm", C: "ohm"},
    steps=(
        Step(R, Piecewise((row, Eq(k, 0)), (parallel, True), evaluate=False), "ohm"),
        Step(I, U / R, "mA"),
    ),
    traps={
        "other-circuit": Step(
            R, Piecewise((parallel, Eq(k, 0)), (row, True), evaluate=False), "ohm"
        ),
        "mean": Step(R, (A + B + C) / 3, "ohm"),
        "one-resistor": Step(I, U / A, "mA"),
    },
)
