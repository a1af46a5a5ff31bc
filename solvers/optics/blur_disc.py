"""Blur disc of a point whose sharp image does not lie on the sensor.

Source: S. J. Ray, Applied Photographic Optics, 3rd ed. (2002), chapter 22 (depth of focus).
"""

from sympy import Abs, evaluate, symbols

from quizgen.maths.model import Model, Step

f, N_1, N_2, p = symbols("f N_1 N_2 p", positive=True)
z_p, z_s = symbols("z'_p z'_s", positive=True)
D, c, D_2, c_2, n = symbols("D c D_2 c_2 n", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "mm", N_1: "", N_2: "", z_p: "mm", z_s: "mm", p: "um"},
        steps=(
            Step(D, f / N_1, "mm"),
            Step(c, D * (Abs(z_s - z_p) / z_p), "um"),
            Step(D_2, f / N_2, "mm"),
            Step(c_2, c * (D_2 / D), "um"),
            Step(n, c / p),
        ),
        formulas={"D": "F31", "c": "F33", "D_2": "F31", "c_2": "F33"},
        traps={
            "sensor-distance-below": Step(c, D * (Abs(z_s - z_p) / z_s)),
            "aperture-below": Step(c, z_p * (Abs(z_s - z_p) / D)),
            "sign-kept": Step(c, D * ((z_s - z_p) / z_p)),
            "radius": Step(c, D * (Abs(z_s - z_p) / (2 * z_p))),
            "ratio-inverted": Step(c_2, c * (D / D_2)),
            "ratio-squared": Step(c_2, c * (D_2 / D) ** 2),
            "pixels-inverted": Step(n, p / c),
            "radius-in-pixels": Step(n, c / (2 * p)),
        },
    )
