"""Pixels that a scan needs: of film by its line pairs, of a page by dots per inch."""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

W, H, r, A, B, d, i = symbols("W H r A B d i", positive=True)
M_1, M_2 = symbols("M_1 M_2", positive=True)

with evaluate(False):
    MODEL = Model(
        given={W: "mm", H: "mm", r: "lp/mm", A: "mm", B: "mm", d: "", i: "mm"},
        steps=(
            Step(M_1, (2 * r * W) * (2 * r * H) / 10**6),
            Step(M_2, (A / i * d) * (B / i * d) / 10**6),
        ),
        traps={
            "one-per-pair": Step(M_1, (r * W) * (r * H) / 10**6),
            "one-side": Step(M_2, (A / i * d) * d / 10**6),
            "centimetres": Step(M_2, (A / i * d * 127 / 50) * (B / i * d * 127 / 50) / 10**6),
        },
    )
