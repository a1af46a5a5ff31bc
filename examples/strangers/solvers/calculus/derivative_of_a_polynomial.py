"""The derivative of a polynomial of drawn degree, and its value at a place."""

from sympy import Eq, Function, Piecewise, diff, symbols

from quizgen.maths.lists import at
from quizgen.maths.model import Model, Step

n, c, s, D, x = symbols("n c s D x")
f, df = Function("f")(x), Function("df")(x)


def by_degree(term):
    """Return the sum of a term for each power, up to the degree that is drawn."""
    sums = [sum(term(at(c, k), k) for k in range(1, degree + 1)) for degree in range(1, 6)]
    return Piecewise(*((one, Eq(n, k)) for k, one in enumerate(sums[:-1], 1)), (sums[-1], True))


MODEL = Model(
    given={n: "", c: "", s: ""},
    free=("x",),
    steps=(
        Step(f, by_degree(lambda a, k: a * x**k)),
        Step(df, diff(f, x)),
        Step(D, df.subs(x, s)),
    ),
    traps={
        "power-kept": Step(df, by_degree(lambda a, k: k * a * x**k)),
        "factor-lost": Step(df, by_degree(lambda a, k: a * x ** (k - 1))),
    },
)
