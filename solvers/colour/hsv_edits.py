"""What an edit of V, S or H does to a colour, without a detour through the hue.

Source: Smith, Color gamut transform pairs, SIGGRAPH 1978: V is the largest channel, and at constant
V and H the other channels keep their proportions to it.
"""

from sympy import Max, Min, Piecewise, Rational, evaluate, symbols

from quizgen.maths.model import Model, Step

R, G, B, a, b, delta = symbols("R G B a b delta", real=True)
V, m = symbols("V m", real=True)
R_V, G_V, B_V, R_S, G_S, B_S, R_H, G_H, B_H = symbols(
    "R_V G_V B_V R_S G_S B_S R_H G_H B_H", real=True
)

with evaluate(False):
    mean = Rational(1, 3) * (R + G + B)
    MODEL = Model(
        given={R: "", G: "", B: "", a: "", b: "", delta: "deg"},
        steps=(
            Step(V, Max(R, G, B)),
            Step(m, Min(R, G, B)),
            Step(R_V, a * R),
            Step(G_V, a * G),
            Step(B_V, a * B),
            Step(R_S, V - b * (V - R)),
            Step(G_S, V - b * (V - G)),
            Step(B_S, V - b * (V - B)),
            Step(R_H, Piecewise((B, delta < 150), (V + m - R, delta < 200), (G, True))),
            Step(G_H, Piecewise((R, delta < 150), (V + m - G, delta < 200), (B, True))),
            Step(B_H, Piecewise((G, delta < 150), (V + m - B, delta < 200), (R, True))),
        ),
        formulas={"V": "F23"},
        traps={
            "only-largest": (
                Step(R_V, Piecewise((a * R, R >= V), (R, True))),
                Step(G_V, Piecewise((a * G, G >= V), (G, True))),
                Step(B_V, Piecewise((a * B, B >= V), (B, True))),
            ),
            "faded-instead": (
                Step(R_V, V - a * (V - R)),
                Step(G_V, V - a * (V - G)),
                Step(B_V, V - a * (V - B)),
            ),
            "subtracted": (Step(R_V, R - a), Step(G_V, G - a), Step(B_V, B - a)),
            "darkened-instead": (Step(R_S, b * R), Step(G_S, b * G), Step(B_S, b * B)),
            "towards-mean": (
                Step(R_S, mean + b * (R - mean)),
                Step(G_S, mean + b * (G - mean)),
                Step(B_S, mean + b * (B - mean)),
            ),
            "towards-smallest": (
                Step(R_S, m + b * (R - m)),
                Step(G_S, m + b * (G - m)),
                Step(B_S, m + b * (B - m)),
            ),
            "step-for-rest": (
                Step(R_S, R + b * (V - R)),
                Step(G_S, G + b * (V - G)),
                Step(B_S, B + b * (V - B)),
            ),
            "other-way-round": (
                Step(R_H, Piecewise((G, delta < 150), (V + m - R, delta < 200), (B, True))),
                Step(G_H, Piecewise((B, delta < 150), (V + m - G, delta < 200), (R, True))),
                Step(B_H, Piecewise((R, delta < 150), (V + m - B, delta < 200), (G, True))),
            ),
            "two-swapped": (Step(R_H, G), Step(G_H, R), Step(B_H, B)),
            "negative": (Step(R_H, 1 - R), Step(G_H, 1 - G), Step(B_H, 1 - B)),
        },
    )
