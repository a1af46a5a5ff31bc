"""Axial colour: red is focused behind green, so a distant point has a red disc around it.

Source: E. Hecht, Optics, 5th ed. (2017), section 6.3.2: axial chromatic aberration.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

f, N, e, p = symbols("f N e p", positive=True)
D, f_r, c, n, N_2 = symbols("D f_r c n N_2", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "mm", N: "", e: "mm", p: "um"},
        steps=(
            Step(D, f / N, "mm"),
            Step(f_r, f + e, "mm"),
            Step(c, D * ((f_r - f) / f_r), "um"),
            Step(n, c / p),
            Step(N_2, N * n),
        ),
        formulas={"D": "F31"},
        traps={
            "no-aperture": Step(c, f_r - f, "um"),
            "radius": Step(c, D / 2 * ((f_r - f) / f_r), "um"),
            "number-multiplied": Step(D, f * N, "mm"),
            "pixels-inverted": Step(n, p / c),
            "opened": Step(N_2, N / n),
            "two-pixels": Step(N_2, N * n / 2),
        },
    )
