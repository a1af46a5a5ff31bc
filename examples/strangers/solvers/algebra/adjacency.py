"""The adjacency matrix of a directed graph on four nodes."""

from sympy import Matrix, symbols

from quizgen.maths.lists import at
from quizgen.maths.model import Model, Step

e = symbols("e")
A = Matrix(4, 4, [at(e, n) for n in range(1, 17)])
MODEL = Model(
    given={e: ""},
    steps=(Step("A", A),),
    traps={
        "turned": Step("A", A.T),
        "undirected": Step("A", Matrix(4, 4, lambda i, j: A[i, j] + A[j, i])),
    },
)
