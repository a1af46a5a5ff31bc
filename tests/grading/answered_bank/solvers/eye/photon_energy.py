"""Energy of a photon, and the longest wavelength that a detector answers to.

Source: SI Brochure, 9th ed. (2019): h, c and e are exact, hc = 1239.84 eV nm.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

k, wavelength, gap = symbols("k lambda E_g", positive=True)
energy, longest = symbols("E lambda_g", positive=True)

with evaluate(False):
    MODEL = Model(
        given={k: "eV·nm", wavelength: "nm", gap: "eV"},
        steps=(
            Step(energy, k / wavelength, "eV"),
            Step(longest, k / gap, "nm"),
        ),
        alternatives=(Step(longest, wavelength * energy / gap),),
        traps={
            "multiplied": Step(energy, k * wavelength * 10**18),
            "upside-down": Step(energy, wavelength / k),
            "gap-multiplied": Step(longest, k * gap),
            "energies-added": Step(longest, k / (gap + energy)),
            "own-wavelength": Step(longest, wavelength * gap),
        },
    )
