"""Joint probabilities of two events, in percent."""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

b, s, t = symbols("b s t")
BS, BT, AS, AT, S, T, A = symbols("BS BT AS AT S T A")
with evaluate(False):
    MODEL = Model(
        given={b: "", s: "", t: ""},
        steps=(
            Step(BS, b * s / 100),
            Step(BT, b - BS),
            Step(A, 100 - b),
            Step(AS, A * t / 100),
            Step(AT, A - AS),
            Step(S, BS + AS),
            Step(T, BT + AT),
        ),
        traps={
            "conditional": (Step(BS, s), Step(AS, t)),
            "same-share": Step(AS, A * s / 100),
        },
    )
