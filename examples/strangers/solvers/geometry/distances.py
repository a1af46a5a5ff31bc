"""Three distances between two points of the plane."""

from sympy import Abs, Max, evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

a, b, p, q, d_1, d_2, d_m = symbols("a b p q d_1 d_2 d_m")
with evaluate(False):
    MODEL = Model(
        given={a: "", b: "", p: "", q: ""},
        steps=(
            Step(d_1, Abs(p - a) + Abs(q - b)),
            Step(d_2, sqrt((p - a) ** 2 + (q - b) ** 2)),
            Step(d_m, Max(Abs(p - a), Abs(q - b))),
        ),
        traps={
            "signs-kept": Step(d_1, Abs(p - a + q - b)),
            "root-left-out": Step(d_2, (p - a) ** 2 + (q - b) ** 2),
            "smaller": Step(d_m, (Abs(p - a) + Abs(q - b) - Abs(Abs(p - a) - Abs(q - b))) / 2),
        },
    )
