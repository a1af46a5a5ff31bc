"""Image of a point just outside the focal plane, and the form of the lens equation that loses it.

Source: E. Hecht, Optics, 5th ed. (2017), section 5.2.3 (Newton: x_o x_i = f^2).
"""

from sympy import Rational, evaluate, symbols

from quizgen.maths.model import Model, Step

f, d = symbols("f d", positive=True)
x, image, z, F = symbols("x' z' z F", real=True)
MILLIMETRE = Rational(1, 1000)

with evaluate(False):
    MODEL = Model(
        given={f: "mm", d: "um"},
        steps=(
            Step(x, f**2 / d, "m"),
            Step(image, f + x, "m"),
            Step(z, f + d, "mm"),
            Step(F, 1 / (1 / f - 1 / z), "m"),
        ),
        formulas={"F": "F42"},
        traps={
            "millimetres": Step(x, f**2 / (1000 * d)),
            "ratio": Step(image, (f / d) * MILLIMETRE),
        },
    )
