"""Hyperfocal distance, where its sharp zone begins, and the f-number that moves that place.

Source: S. J. Ray, Applied Photographic Optics, 3rd ed. (2002), chapter 22.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

f, N, c, q = symbols("f N c q", positive=True)
H, near, N_2 = symbols("H z_n N_2", positive=True)

with evaluate(False):
    MODEL = Model(
        given={f: "mm", N: "", c: "um", q: "m"},
        steps=(
            Step(H, f**2 / (N * c) + f, "m"),
            Step(near, H / 2, "m"),
            Step(N_2, f**2 / (c * (2 * q - f))),
        ),
        alternatives=(Step(N_2, N * (H - f) / (2 * q - f)),),
        traps={
            "not-squared": Step(H, f / (N * c)),
            "number-forgotten": Step(H, f**2 / c + f),
            "times-number": Step(H, N * f**2 / c + f),
            "nearest-as-hyperfocal": Step(N_2, f**2 / (c * (q - f))),
            "halved-again": Step(N_2, f**2 / (c * (q / 2 - f))),
        },
    )
