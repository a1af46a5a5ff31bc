"""Size of an object's image on the sensor and in pixels, and the distance that fills the sensor.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), eq. 6.1 for one coordinate.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

p_y, p_z, f, s, S = symbols("p_y p_z f s S", positive=True)
h, n, z_1, q = symbols("p'_y n z_1 q", positive=True)

with evaluate(False):
    MODEL = Model(
        given={p_y: "m", p_z: "m", f: "mm", s: "um/px", S: "mm"},
        steps=(
            Step(h, f * p_y / p_z, "mm"),
            Step(n, h / s, "px"),
            Step(z_1, f * p_y / S, "m"),
            Step(q, p_z / z_1),
        ),
        formulas={"p'_y": "F05", "z_1": "F10", "n": "F08"},
        alternatives=(Step(z_1, p_z * h / S),),
        traps={
            "size-distance-swapped": Step(h, f * p_z / p_y),
            "forgot-f": Step(h, p_y / p_z / 1000),
            "divided-by-f": Step(h, p_y / (p_z * f) / 1000000),
            "pitch-multiplied": Step(n, (1000000 * h) * (1000000 * s)),
            "object-over-pitch": Step(n, p_y / s / 1000),
            "half-sensor": Step(z_1, f * p_y / (S / 2)),
            "inverted-ratio": Step(z_1, p_z * S / h),
            "pixels-for-height": Step(z_1, 1000 * f * p_y / n),
        },
    )
