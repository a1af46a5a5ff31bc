"""Photon (shot) noise: the signal-to-noise ratio of two Poisson counts, and decibels.

Source: J. R. Janesick, Photon Transfer (2007), chapter 3.
"""

from sympy import evaluate, log, sqrt, symbols

from quizgen.maths.model import Model, Step

N_1, N_2 = symbols("N_1 N_2", positive=True)
sigma_1, sigma_2 = symbols("sigma_1 sigma_2", real=True)
SNR_1, SNR_2, L = symbols("SNR_1 SNR_2 L", real=True)

with evaluate(False):
    MODEL = Model(
        given={N_1: "", N_2: ""},
        steps=(
            Step(sigma_1, sqrt(N_1)),
            Step(SNR_1, N_1 / sigma_1),
            Step(sigma_2, sqrt(N_2)),
            Step(SNR_2, N_2 / sigma_2),
            Step(L, 20 * log(SNR_2, 10), "dB"),
        ),
        formulas={"SNR_1": "F45", "SNR_2": "F45", "L": "F45"},
        traps={
            "photons-as-ratio": (Step(SNR_1, N_1), Step(SNR_2, N_2)),
            "light-ratio": Step(SNR_2, SNR_1 * N_2 / N_1),
            "variance-as-deviation": (Step(sigma_1, N_1), Step(sigma_2, N_2)),
            "ten-for-twenty": Step(L, 10 * log(SNR_2, 10)),
            "photons-in-decibels": Step(L, 20 * log(N_2, 10)),
            "natural-logarithm": Step(L, 20 * log(SNR_2)),
        },
    )
