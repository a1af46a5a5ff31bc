"""The product of two matrices of drawn sizes."""

from sympy import Eq, Matrix, Piecewise, symbols

from quizgen.maths.lists import at
from quizgen.maths.model import Model, Step

a, b, k = symbols("a b k")


def matrix(entries, rows, columns):
    """Return the first entries of a list as a matrix."""
    return Matrix(rows, columns, [at(entries, i + 1) for i in range(rows * columns)])


def by_size(rule):
    """Return what a rule makes of both matrices, in each of the sizes that are drawn."""
    sizes = ((2, 3, 2), (3, 2, 3), (2, 2, 3), (1, 3, 2))
    found = [rule(matrix(a, n, m), matrix(b, m, p)) for n, m, p in sizes]
    return Piecewise(*((one, Eq(k, i)) for i, one in enumerate(found[:-1])), (found[-1], True))


MODEL = Model(
    given={a: "", b: "", k: ""},
    steps=(
        Step("A", by_size(lambda A, B: A)),
        Step("B", by_size(lambda A, B: B)),
        Step("P", by_size(lambda A, B: A * B)),
    ),
    traps={
        "transposed": Step("P", by_size(lambda A, B: (A * B).T)),
        "rows-with-rows": Step(
            "P", by_size(lambda A, B: A * Matrix(*B.shape, [B.T[i] for i in range(len(B))]))
        ),
    },
)
