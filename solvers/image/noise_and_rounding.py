"""Sensor noise and rounding noise of a converter added as variances.

Source: Nakamura (ed.), Image Sensors and Signal Processing (2006), section 3.2.
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

sigma, step = symbols("sigma Delta", positive=True)
rounding, total, finer = symbols("sigma_q sigma_t sigma_f", positive=True)

with evaluate(False):
    MODEL = Model(
        given={sigma: "e-", step: "e-"},
        steps=(
            Step(rounding, step / sqrt(12), "e-"),
            Step(total, sqrt(sigma**2 + rounding**2), "e-"),
            Step(finer, sqrt(sigma**2 + (rounding / 2) ** 2), "e-"),
        ),
        traps={
            "half-step": Step(rounding, step / 2),
            "no-root": Step(rounding, step / 12),
            "whole-step": Step(rounding, step),
            "noises-added": Step(total, sigma + rounding),
            "root-left-out": Step(total, sigma**2 + rounding**2),
            "halved": Step(finer, total / 2),
            "sensor-halved": Step(finer, sqrt((sigma / 2) ** 2 + rounding**2)),
        },
    )
