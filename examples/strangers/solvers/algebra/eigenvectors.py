"""A matrix of three rows with drawn eigenvalues and eigenvectors."""

from sympy import FiniteSet, Matrix, diag, symbols

from quizgen.maths.model import Model, Step

p, q, r, s, t = symbols("p q r s t")
V = Matrix([[1, 0, p], [q, 1, p * q], [0, 0, 1]])
MODEL = Model(
    given={p: "", q: "", r: "", s: "", t: ""},
    steps=(
        Step("A", V * diag(r, s, t) * V.inv()),
        Step("E", FiniteSet(r, s, t)),
        Step("u", V[:, 0]),
        Step("v", V[:, 1]),
        Step("w", V[:, 2]),
    ),
    traps={
        "signs": Step("E", FiniteSet(-r, -s, -t)),
        "another-u": Step("u", V[:, 1]),
        "row": Step("w", Matrix([0, 0, 1])),
    },
)
