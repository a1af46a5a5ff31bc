"""A lamp on a CCD: charge that overflows along its column, and the streak of the transfer.

Source: J. R. Janesick, Scientific Charge-Coupled Devices (2001), chapters 4 and 5.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

Q, F, b, h, t, t_r = symbols("Q F b h t t_r", positive=True)
X, n, e = symbols("X n e", real=True)

with evaluate(False):
    MODEL = Model(
        given={Q: "e-", F: "e-", b: "e-", h: "", t: "ms", t_r: "us"},
        steps=(
            Step(X, h * (Q - F), "e-"),
            Step(n, X / (F - b)),
            Step(e, h * (Q * (t_r / t)), "e-"),
        ),
        traps={
            "one-photosite": Step(X, Q - F, "e-"),
            "nothing-kept": Step(X, h * Q, "e-"),
            "empty-neighbours": Step(n, X / F),
            "background-room": Step(n, X / b),
            "one-row": Step(e, Q * (t_r / t), "e-"),
            "full-well-in-streak": Step(e, h * (F * (t_r / t)), "e-"),
            "overflow-in-streak": Step(e, X * (t_r / t), "e-"),
        },
    )
