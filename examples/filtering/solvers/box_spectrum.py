"""Spectrum of a mean over n samples, as a box of that width: sin(pi n f) / (pi n f).

Source: Szeliski, Computer Vision, 2nd ed. (2022), section 3.4.
"""

from sympy import evaluate, pi, sin, symbols

from quizgen.maths.model import Model, Step

n, p = symbols("n p", positive=True)
z, f, x, a = symbols("f_0 f x a", real=True)

with evaluate(False):
    MODEL = Model(
        given={n: "px", p: "px"},
        steps=(
            Step(z, 1 / n, "cycle/px"),
            Step(f, 1 / p, "cycle/px"),
            Step(x, pi * n * f),
            Step(a, sin(x) / x),
        ),
        traps={
            "half-width": Step(z, 2 / n),
            "twice-the-width": Step(z, 1 / (2 * n)),
            "width-itself": Step(z, n),
            "not-divided": Step(a, sin(x)),
            "pi-forgotten": Step(x, n * f),
            "twice-pi": Step(x, 2 * pi * n * f),
            "degrees": Step(a, sin(pi * x / 180) / x),
            "cosine": Step(a, 1 - x**2 / 2),
        },
    )
