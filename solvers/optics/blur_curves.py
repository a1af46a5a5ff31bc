"""Blur disc against distance: where it stays below a limit, and what another f-number makes of it.

Source: S. J. Ray, Applied Photographic Optics, 3rd ed. (2002), chapter 22; thin lens, exact.
"""

from sympy import Abs, evaluate, symbols

from quizgen.maths.model import Model, Step

f, N_1, k, c, s, z = symbols("f N_1 k c s z", positive=True)
near, far, c_1, c_2, N_2 = symbols("z_n z_f c_1 c_2 N_2", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "mm", N_1: "", k: "", c: "um", s: "m", z: "m"},
        steps=(
            Step(near, s * f**2 / (f**2 + N_1 * c * (s - f)), "m"),
            Step(far, s * f**2 / (f**2 - N_1 * c * (s - f)), "m"),
            Step(c_1, f**2 * Abs(z - s) / (N_1 * z * (s - f)), "um"),
            Step(c_2, c_1 / k, "um"),
            Step(N_2, N_1 * (c_1 / c_2)),
        ),
        formulas={"c_1": "F33"},
        traps={
            "other-curve": (
                Step(near, s * f**2 / (f**2 + k * N_1 * c * (s - f))),
                Step(far, s * f**2 / (f**2 - k * N_1 * c * (s - f))),
            ),
            "exchanged": (
                Step(near, s * f**2 / (f**2 - N_1 * c * (s - f))),
                Step(far, s * f**2 / (f**2 + N_1 * c * (s - f))),
            ),
            "wrong-curve": Step(c_1, f**2 * Abs(z - s) / (k * N_1 * z * (s - f))),
            "ratio-inverted": Step(N_2, N_1 * (c_2 / c_1)),
            "ratio-squared": Step(N_2, N_1 * (c_1 / c_2) ** 2),
        },
    )
