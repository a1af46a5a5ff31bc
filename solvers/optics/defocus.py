"""Blur disc of a thing that stands before or behind the plane of focus.

Source: S. J. Ray, Applied Photographic Optics, 3rd ed. (2002), chapter 22; thin lens, exact.
"""

from sympy import Abs, evaluate, symbols

from quizgen.maths.model import Model, Step

f, N, s, z = symbols("f N s z", positive=True)
D, c = symbols("D c", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "mm", N: "", s: "m", z: "m"},
        steps=(
            Step(D, f / N, "mm"),
            Step(c, D * (f / (s - f)) * (Abs(z - s) / z), "mm"),
        ),
        formulas={"D": "F31", "c": "F33"},
        traps={
            "over-focus": Step(c, D * (f / (s - f)) * (Abs(z - s) / s)),
            "number-forgotten": Step(c, f * (f / (s - f)) * (Abs(z - s) / z)),
            "opening-only": Step(c, D * (Abs(z - s) / z)),
        },
    )
