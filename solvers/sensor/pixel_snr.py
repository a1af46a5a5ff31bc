"""Signal-to-noise ratio of one photosite with shot noise, dark current and read noise.

Source: J. R. Janesick, Photon Transfer (2007), chapter 3: independent noises add in squares, and a
count of independent electrons has its mean as variance.
"""

from sympy import Add, evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

S, D, sigma_r = symbols("S D sigma_r", positive=True)
V, sigma, SNR = symbols("V sigma SNR", real=True)

with evaluate(False):
    MODEL = Model(
        given={S: "e-", D: "e-", sigma_r: "e-"},
        steps=(
            Step(V, Add(S, D, sigma_r**2)),
            Step(sigma, sqrt(V), "e-"),
            Step(SNR, S / sigma),
        ),
        traps={
            "added-linearly": Step(sigma, Add(sqrt(S), sqrt(D), sigma_r)),
            "read-noise-not-squared": Step(V, Add(S, D, sigma_r)),
            "dark-current-left-out": Step(V, S + sigma_r**2),
            "shot-noise-left-out": Step(V, D + sigma_r**2),
            "counts-squared": Step(V, Add(S**2, D**2, sigma_r**2)),
            "variance-for-deviation": Step(SNR, S / V),
            "dark-as-signal": Step(SNR, (S + D) / sigma),
            "photons-alone": Step(SNR, sqrt(S)),
        },
    )
