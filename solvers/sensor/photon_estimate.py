"""Photons that a pixel collects from a lit scene, estimated, and their signal-to-noise ratio.

Source: EMVA Standard 1288; illuminance behind a lens from E. Hecht, Optics, 5th ed. (2017).
"""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

E, R, N, p, t, K, e = symbols("E R N p t K e", positive=True)
E_s, Phi, n, snr = symbols("E_s Phi n SNR", positive=True)

with evaluate(False):
    MODEL = Model(
        given={E: "lx", R: "", N: "", p: "um", t: "s", K: "lm/W", e: "J"},
        steps=(
            Step(E_s, R * E / (4 * N**2), "lx"),
            Step(Phi, E_s * p**2, "lm"),
            Step(n, Phi * t / (K * e)),
            Step(snr, sqrt(n)),
        ),
        formulas={"SNR": "F45"},
        traps={
            "all-light": Step(E_s, E),
            "no-lens": Step(E_s, R * E),
            "photons-as-ratio": Step(snr, n),
        },
    )
