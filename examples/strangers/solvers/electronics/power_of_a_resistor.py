"""Power of a resistor from voltage and current, in coherent units."""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

U, I, P, R = symbols("U I P R")
with evaluate(False):
    MODEL = Model(
        given={U: "V", I: "mA"},
        steps=(Step(P, U * I, "mW"), Step(R, U / I, "ohm")),
        traps={"halved": Step(P, U * I / 2, "mW"), "doubled": Step(R, 2 * U / I, "ohm")},
    )
