"""Bilinear demosaicing of an RGGB mosaic at a blue site and at the green site to its right.

Source: R. Szeliski, Computer Vision, 2nd ed. (2022), section 2.3.2. The reds stand at the corners,
the greens at the edges: 1 above, 2 left, 3 right, 4 below.
"""

from typing import Any

from sympy import Add, Max, Min, evaluate, symbols

from quizgen.maths.model import Model, Step

G_1, G_2, G_3, G_4 = symbols("G_1 G_2 G_3 G_4", real=True)
R_1, R_2, R_3, R_4, B = symbols("R_1 R_2 R_3 R_4 B", real=True)
green, red, red_right = symbols("Ghat Rhat Rhat_g", real=True)


def _middle(a: Any, b: Any, c: Any, d: Any) -> Any:
    """Median of four: the mean of the two in the middle."""
    return (a + b + c + d - Max(a, b, c, d) - Min(a, b, c, d)) / 2


with evaluate(False):
    GREENS, REDS = Add(G_1, G_2, G_3, G_4), Add(R_1, R_2, R_3, R_4)
    MODEL = Model(
        given=dict.fromkeys((G_1, G_2, G_3, G_4, R_1, R_2, R_3, R_4, B), ""),
        steps=(
            Step(green, GREENS / 4),
            Step(red, REDS / 4),
            Step(red_right, (R_2 + R_4) / 2),
        ),
        formulas={"Ghat": "F28", "Rhat": "F29", "Rhat_g": "F30"},
        traps={
            "half-of-four": (Step(green, GREENS / 2), Step(red, REDS / 2)),
            "centre-included": (
                Step(green, Add(G_1, G_2, G_3, G_4, B) / 5),
                Step(red, Add(R_1, R_2, R_3, R_4, B) / 5),
            ),
            "corners-for-green": (Step(green, REDS / 4), Step(red, GREENS / 4)),
            "eight-neighbours": (
                Step(green, (GREENS + REDS) / 8),
                Step(red, (GREENS + REDS) / 8),
            ),
            "median": (
                Step(green, _middle(G_1, G_2, G_3, G_4)),
                Step(red, _middle(R_1, R_2, R_3, R_4)),
            ),
            "all-four-reds": Step(red_right, REDS / 4),
            "not-halved": Step(red_right, R_2 + R_4),
            "row-for-column": Step(red_right, (R_1 + R_2) / 2),
        },
    )
