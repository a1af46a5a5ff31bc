"""Size of an object's image on the sensor and in pixels, and the distance that fills the sensor.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), eq. 6.1 for one coordinate.
"""

from sympy import evaluate, symbols

from quizgen.model import Model, Step

X, Z, f, s, S = symbols("X Z f s S", positive=True)
h, n, Z_1, q = symbols("h n Z_1 q", positive=True)

with evaluate(False):
    MODEL = Model(
        given={X: "m", Z: "m", f: "mm", s: "um/px", S: "mm"},
        steps=(
            Step(h, f * X / Z, "mm"),
            Step(n, h / s, "px"),
            Step(Z_1, f * X / S, "m"),
            Step(q, Z / Z_1),
        ),
        traps={
            "size-distance-swapped": Step(h, f * Z / X),
            "forgot-f": Step(h, X / Z / 1000),
            "divided-by-f": Step(h, X / (Z * f) / 1000000),
            "pitch-multiplied": Step(n, (1000000 * h) * (1000000 * s)),
            "object-over-pitch": Step(n, X / s / 1000),
            "half-sensor": Step(Z_1, f * X / (S / 2)),
            "inverted-ratio": Step(Z_1, Z * S / h),
            "pixels-for-height": Step(Z_1, 1000 * f * X / n),
        },
    )
