"""One projection formula solved for focal length, object size and distance in turn.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), eq. 6.1 for one coordinate.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

y_1, z_1, h_1, z_2, h_2, y_3, h_3 = symbols("y_1 z_1 h_1 z_2 h_2 y_3 h_3", positive=True)
f, y_2, z_3 = symbols("f y_2 z_3", positive=True)

with evaluate(False):
    MODEL = Model(
        given={y_1: "m", z_1: "m", h_1: "mm", z_2: "m", h_2: "mm", y_3: "m", h_3: "mm"},
        steps=(
            Step(f, h_1 * z_1 / y_1, "mm"),
            Step(y_2, h_2 * z_2 / f, "m"),
            Step(z_3, f * y_3 / h_3, "m"),
        ),
        formulas={"f": "F10", "y_2": "F05", "z_3": "F10"},
        traps={
            "focal-upside-down": Step(f, h_1 * y_1 / z_1),
            "focal-ratio-only": Step(f, z_1 / y_1 / 1000),
            "size-multiplied": Step(y_2, h_2 * f * z_2 * 1000),
            "size-without-distance": Step(y_2, h_2 / f),
            "size-inverse": Step(y_2, f * z_2 / h_2),
            "distance-inverse": Step(z_3, h_3 * y_3 / f),
            "distance-without-focal": Step(z_3, y_3 / h_3 / 1000),
            "distance-multiplied": Step(z_3, f * y_3 * h_3 * 1000000),
        },
    )
