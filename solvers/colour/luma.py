"""Luma of a gamma-encoded pixel, before and after its hue is turned by a third of a circle.

Sources: ITU-R BT.601-7 and BT.709-6.
"""

from sympy import Add, Max, evaluate, symbols

from quizgen.maths.model import Model, Step

R, G, B, R_2, G_2, B_2 = symbols("R G B R_2 G_2 B_2", real=True)
old, new, turned = symbols("Y_601 Y_709 Y_t", real=True)

with evaluate(False):
    MODEL = Model(
        given={R: "", G: "", B: "", R_2: "", G_2: "", B_2: ""},
        steps=(
            Step(old, Add(0.299 * R, 0.587 * G, 0.114 * B)),
            Step(new, Add(0.2126 * R, 0.7152 * G, 0.0722 * B)),
            Step(turned, Add(0.2126 * R_2, 0.7152 * G_2, 0.0722 * B_2)),
        ),
        traps={
            "mean": (
                Step(old, (R + G + B) / 3),
                Step(new, (R + G + B) / 3),
            ),
            "largest": (Step(old, Max(R, G, B)), Step(new, Max(R, G, B))),
            "red-and-blue-swapped": (
                Step(old, Add(0.114 * R, 0.587 * G, 0.299 * B)),
                Step(new, Add(0.0722 * R, 0.7152 * G, 0.2126 * B)),
            ),
            "same-weights": Step(new, Add(0.299 * R, 0.587 * G, 0.114 * B)),
            "unchanged": Step(turned, new),
            "turned-back": Step(turned, Add(0.2126 * G, 0.7152 * B, 0.0722 * R)),
            "old-weights": Step(turned, Add(0.299 * R_2, 0.587 * G_2, 0.114 * B_2)),
        },
    )
