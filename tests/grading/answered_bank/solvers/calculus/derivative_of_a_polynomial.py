"""The derivative of a polynomial with drawn coefficients, and its value at a place."""

from sympy import Function, diff, symbols

from quizgen.maths.model import Model, Step

a, b, c, s, D, x = symbols("a b c s D x")
f, df = Function("f")(x), Function("df")(x)
MODEL = Model(
    given={a: "", b: "", c: "", s: ""},
    free=("x",),
    steps=(Step(f, a * x**3 + b * x**2 + c * x), Step(df, diff(f, x)), Step(D, df.subs(x, s))),
    traps={
        "power-kept": Step(df, 3 * a * x**3 + 2 * b * x**2 + c * x),
        "factor-lost": Step(df, a * x**2 + b * x + c),
    },
)
