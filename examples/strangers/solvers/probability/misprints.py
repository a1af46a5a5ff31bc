"""Misprints on a page: Poisson's distribution."""

from sympy import Sum, evaluate, exp, factorial, symbols

from quizgen.maths.model import Model, Step

m, n, c, k = symbols("m n c k")
mu, p_0, p_c, p_2, p_1 = symbols("mu p_0 p_c p_2 p_1")
with evaluate(False):
    MODEL = Model(
        given={m: "", n: "", c: ""},
        steps=(
            Step(mu, m / n),
            Step(p_0, exp(-mu)),
            Step(p_c, mu**c * exp(-mu) / factorial(c)),
            Step(p_2, Sum(mu**k * exp(-mu) / factorial(k), (k, 0, 2))),
            Step(p_1, 1 - exp(-mu) - mu * exp(-mu)),
        ),
        traps={
            "pages-per-misprint": Step(mu, n / m),
            "factorial-lost": Step(p_c, mu**c * exp(-mu)),
            "less-than": Step(p_2, exp(-mu) + mu * exp(-mu)),
            "one-included": Step(p_1, 1 - exp(-mu)),
        },
    )
