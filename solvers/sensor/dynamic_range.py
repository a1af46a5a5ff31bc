"""Dynamic range of a photosite: largest over smallest distinguishable charge, in stops and dB.

Source: J. R. Janesick, Photon Transfer (2007), chapter 2; EMVA Standard 1288, release 4.0.
"""

from sympy import ceiling, evaluate, log, symbols

from quizgen.maths.model import Model, Step

Q, sigma_r = symbols("Q_max sigma_r", positive=True)
R, E, L, n = symbols("R E L n", real=True)

with evaluate(False):
    MODEL = Model(
        given={Q: "e-", sigma_r: "e-"},
        steps=(
            Step(R, Q / sigma_r),
            Step(E, log(R, 2), "stop"),
            Step(L, 20 * log(R, 10), "dB"),
            Step(n, ceiling(E), "bit"),
        ),
        formulas={"E": "F34", "L": "F45"},
        alternatives=(Step(L, 20 * log(2, 10) * E),),
        traps={
            "read-noise-ignored": Step(R, Q),
            "read-noise-squared": Step(R, Q / sigma_r**2),
            "square-root": Step(R, (Q / sigma_r) ** (1 / 2)),
            "decimal-logarithm": Step(E, log(R, 10)),
            "natural-logarithm": Step(E, log(R)),
            "ten-for-twenty": Step(L, 10 * log(R, 10)),
            "rounded-down": Step(n, ceiling(E) - 1),
            "full-well-alone": Step(n, ceiling(log(Q, 2))),
        },
    )
