"""Best hole of a pinhole camera, its f-number and the exposure time it asks for.

Source: Lord Rayleigh, "On pin-hole photography", Philosophical Magazine 31 (1891), 87-99.
"""

from sympy import Rational, evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

k, f, wave, N_1, r = symbols("k f lambda N_1 r", positive=True)
d, N, t_1, t_2 = symbols("d N t_1 t_2", positive=True)
MILLIMETRE = Rational(1, 1000)

with evaluate(False):
    MODEL = Model(
        given={k: "", f: "mm", wave: "nm", N_1: "", r: ""},
        steps=(
            Step(d, k * sqrt(f * wave), "mm"),
            Step(N, f / d),
            Step(t_1, 1 / r, "s"),
            Step(t_2, t_1 * (N / N_1) ** 2, "s"),
        ),
        formulas={"N": "F31", "t_2": "F35"},
        traps={
            "no-constant": Step(d, sqrt(f * wave)),
            "no-root": Step(d, k * f * wave / MILLIMETRE),
            "inverted": Step(N, d / f),
            "with-radius": Step(N, f / (d / 2)),
            "not-squared": Step(t_2, t_1 * (N / N_1)),
        },
    )
