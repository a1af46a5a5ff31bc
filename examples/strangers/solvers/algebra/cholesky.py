"""A symmetric matrix from its Cholesky factor."""

from sympy import Eq, Matrix, Piecewise, symbols

from quizgen.maths.lists import at
from quizgen.maths.model import Model, Step

n, x = symbols("n x")


def factor(size):
    """Return the lower triangular matrix of a list, column after column."""
    below = iter(range(1, 11))
    entries = {(i, j): at(x, next(below)) for j in range(4) for i in range(j, 4)}
    return Matrix(size, size, lambda i, j: entries.get((i, j), 0))


def by_size(rule):
    """Return what a rule makes of the factor, with three rows or four."""
    return Piecewise((rule(factor(3)), Eq(n, 3)), (rule(factor(4)), True))


MODEL = Model(
    given={n: "", x: ""},
    steps=(Step("A", by_size(lambda L: L * L.T)), Step("L", by_size(lambda L: L))),
)
