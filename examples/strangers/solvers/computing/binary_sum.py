"""The sum of two whole numbers, and what comes out where carries are lost."""

from sympy import symbols

from quizgen.maths.model import Model, Step

a, b, w, o, S = symbols("a b w o S")

MODEL = Model(
    given={a: "", b: "", w: "", o: ""},
    steps=(Step(S, a + b),),
    traps={"carries-lost": Step(S, w), "ored": Step(S, o)},
)
