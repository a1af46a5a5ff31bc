"""Colour differences and lightness in CIE Lab.

Source: CIE 15:2018, Colorimetry, 4th ed., section 8.2.1.
"""

from sympy import Abs, Add, Rational, evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

L_1, L_2, Y, d_L, d_a, d_b = symbols("L_1 L_2 Y d_L d_a d_b", real=True)
a_1, a_2, b_1, b_2 = symbols("a_1 a_2 b_1 b_2", real=True)
light, red, yellow, first, second, L = symbols("Delta_L Delta_a Delta_b E_1 E_2 L", real=True)

with evaluate(False):
    MODEL = Model(
        given={
            L_1: "",
            a_1: "",
            b_1: "",
            L_2: "",
            a_2: "",
            b_2: "",
            d_L: "",
            d_a: "",
            d_b: "",
            Y: "",
        },
        steps=(
            Step(light, L_2 - L_1),
            Step(red, a_2 - a_1),
            Step(yellow, b_2 - b_1),
            Step(first, sqrt(Add(light**2, red**2, yellow**2))),
            Step(second, sqrt(Add(d_L**2, d_a**2, d_b**2))),
            Step(L, 116 * Y ** Rational(1, 3) - 16),
        ),
        traps={
            "sum": (
                Step(first, Add(Abs(light), Abs(red), Abs(yellow))),
                Step(second, Add(Abs(d_L), Abs(d_a), Abs(d_b))),
            ),
            "no-root": Step(first, Add(light**2, red**2, yellow**2)),
            "lightness-left-out": Step(first, sqrt(red**2 + yellow**2)),
            "signs-dropped": (
                Step(red, Abs(a_2) - Abs(a_1)),
                Step(yellow, Abs(b_2) - Abs(b_1)),
            ),
            "in-proportion": Step(L, 100 * Y),
            "square-root": Step(L, 116 * sqrt(Y) - 16),
            "offset-forgotten": Step(L, 116 * Y ** Rational(1, 3)),
            "third-of": Step(L, 116 * (Y / 3) - 16),
        },
    )
