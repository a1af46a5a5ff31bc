"""The product of two matrices, and the determinant of the first."""

from sympy import Matrix, MatrixSymbol, det, symbols

from quizgen.maths.model import Model, Step

a, b, c, d, p, q = symbols("a b c d p q")
A, B = MatrixSymbol("A", 2, 2), MatrixSymbol("B", 2, 2)
Delta = symbols("Delta")
MODEL = Model(
    given={a: "", b: "", c: "", d: "", p: "", q: ""},
    steps=(
        Step(A, Matrix([[a, b], [c, d]])),
        Step(B, Matrix([[p, 1], [0, q]])),
        Step("P", A * B),
        Step(Delta, det(A)),
    ),
    traps={
        "other-order": Step("P", B * A),
        "entry-by-entry": Step("P", Matrix([[a * p, b], [0, d * q]])),
        "plus": Step(Delta, a * d + b * c),
    },
)
