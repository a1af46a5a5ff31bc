"""What two closed intervals have in common."""

from sympy import Interval, symbols

from quizgen.maths.model import Model, Step

a, b, c, d = symbols("a b c d")
MODEL = Model(
    given={a: "", b: "", c: "", d: ""},
    steps=(
        Step("A", Interval(a, b)),
        Step("B", Interval(c, d)),
        Step("S", Interval(c, b)),
    ),
    traps={
        "strict": Step("S", Interval.open(c, b)),
        "union": Step("S", Interval(a, d)),
        "difference": Step("S", Interval.Ropen(a, c)),
    },
)
