"""Mean, mean square error and PSNR of salt and pepper noise on an even grey.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), sections 5.2 and 8.1.
"""

from sympy import evaluate, log, sqrt, symbols

from quizgen.maths.model import Model, Step

v, p, m = symbols("v p m", positive=True)
mean, error, ratio, fall = symbols("mu MSE PSNR d", real=True)

with evaluate(False):
    MODEL = Model(
        given={v: "", p: "%", m: ""},
        steps=(
            Step(mean, (1 - p) * v + p * (255 / 2)),
            Step(error, (p / 2) * v**2 + (p / 2) * (255 - v) ** 2),
            Step(ratio, 10 * log(255**2 / error, 10), "dB"),
            Step(fall, 10 * log(m, 10), "dB"),
        ),
        traps={
            "share-each": (
                Step(mean, (1 - 2 * p) * v + p * 255),
                Step(error, p * v**2 + p * (255 - v) ** 2),
            ),
            "unchanged": Step(mean, v),
            "original-left-out": Step(mean, p * (255 / 2)),
            "only-white": Step(mean, (1 - p) * v + p * 255),
            "root-taken": Step(error, sqrt((p / 2) * v**2 + (p / 2) * (255 - v) ** 2)),
            "only-hit": Step(error, v**2 / 2 + (255 - v) ** 2 / 2),
            "deviations-added": Step(error, (p / 2) * v + (p / 2) * (255 - v)),
            "twenty-for-ten": Step(ratio, 20 * log(255**2 / error, 10)),
            "peak-not-squared": Step(ratio, 10 * log(255 / error, 10)),
            "upside-down": Step(ratio, 10 * log(error / 255**2, 10)),
            "twenty-again": Step(fall, 20 * log(m, 10)),
            "factor-for-decibels": Step(fall, m),
        },
    )
