"""Diffraction at a round opening: the Airy disc in pixels, and where it becomes two pixels wide.

Source: E. Hecht, Optics, 5th ed. (2017), section 10.2.5: radius 1.22 lambda N of the first ring.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

k, wave, N, p = symbols("k lambda N p", positive=True)
d, n, N_2 = symbols("d n N_2", positive=True)

with evaluate(False):
    MODEL = Model(
        given={k: "", wave: "nm", N: "", p: "um"},
        steps=(
            Step(d, k * wave * N, "um"),
            Step(n, d / p),
            Step(N_2, 2 * p / (k * wave)),
        ),
        alternatives=(
            Step(N_2, 2 * p * N / d),
            Step(N_2, 2 * N / n),
        ),
        traps={
            "radius": Step(d, k / 2 * wave * N),
            "no-constant": Step(d, wave * N),
            "over-number": Step(d, k * wave / N),
            "pixels-inverted": Step(n, p / d),
            "one-pixel": Step(N_2, p / (k * wave)),
            "radius-two-pixels": Step(N_2, 2 * p / (k / 2 * wave)),
            "half-pitch": Step(N_2, p / (2 * k * wave)),
        },
    )
