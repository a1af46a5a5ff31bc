"""Sum, product, quotient, square and modulus of complex numbers."""

from sympy import Abs, I, symbols

from quizgen.maths.model import Model, Step

a, b, c, d, r = symbols("a b c d r")
z, w = a + b * I, c + d * I
MODEL = Model(
    given={a: "", b: "", c: "", d: ""},
    steps=(
        Step("z", z),
        Step("w", w),
        Step("s", 2 * z + w),
        Step("u", z * w),
        Step("q", z / w),
        Step("p", z**2),
        Step(r, Abs(z)),
    ),
    traps={
        "once": Step("s", z + w),
        "parts": Step("u", a * c + b * d * I),
        "sign": Step("u", a * c + b * d + (a * d + b * c) * I),
        "not-conjugated": Step("q", z * w / (c**2 + d**2)),
        "once-mixed": Step("p", a**2 - b**2 + a * b * I),
        "sum-of-parts": Step(r, a + Abs(b)),
    },
)
