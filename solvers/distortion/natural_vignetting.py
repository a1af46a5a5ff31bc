"""Natural vignetting: light at a distance from the centre, in stops, and the factor against it.

Source: R. Szeliski, Computer Vision, 2nd ed. (2022), section 2.2.3:
light falls as cos^4 of the angle. What a curve shows, p, is read, not computed.
"""

from sympy import atan, cos, evaluate, log, symbols

from quizgen.maths.model import Model, Step

f, r, p = symbols("f r p", positive=True)
t, q, E, g = symbols("t q E g", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "mm", r: "mm", p: ""},
        steps=(
            Step(t, r / f),
            Step(q, 1 / (1 + t**2) ** 2),
            Step(E, log(1 / q, 2), "stop"),
            Step(g, 1 / q),
        ),
        formulas={"E": "F34"},
        traps={
            "cosine-squared": Step(q, 1 / (1 + t**2)),
            "ratio-for-angle": Step(q, cos(t) ** 4),
            "upside-down": Step(t, f / r),
            "angle-for-cosine": Step(q, atan(t) ** 4),
            "loss-for-rest": Step(q, 1 - 1 / (1 + t**2) ** 2),
            "decimal-logarithm": Step(E, log(1 / q, 10)),
            "natural-logarithm": Step(E, log(1 / q)),
            "share-for-factor": Step(g, q),
            "loss-added": Step(g, 2 - q),
        },
    )
