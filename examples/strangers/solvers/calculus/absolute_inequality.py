"""Two rays: all x whose distance from a is at least b."""

from sympy import Interval, Union, oo, symbols

from quizgen.maths.model import Model, Step

a, b, x = symbols("a b x")
MODEL = Model(
    given={a: "", b: ""},
    steps=(Step("L", Union(Interval(-oo, a - b), Interval(a + b, oo))),),
    traps={
        "between": Step("L", Interval(a - b, a + b)),
        "open": Step("L", Union(Interval.open(-oo, a - b), Interval.open(a + b, oo))),
    },
)
