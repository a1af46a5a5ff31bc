"""Otsu's threshold for a picture with four grey levels: variance between the two classes.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 10.3.
"""

from sympy import Add, evaluate, symbols

from quizgen.maths.model import Model, Step

H = symbols("h_0:4", integer=True)
N, S = symbols("N S", positive=True)
OMEGA = symbols("omega_0:3", positive=True)
DARK = symbols("mu_0:3", real=True)
BRIGHT = symbols("nu_0:3", real=True)
B = symbols("B_0:3", real=True)


def steps() -> list[Step]:
    """Share, two means and variance between the classes for each of the three thresholds."""
    found = []
    for t in range(3):
        dark = Add(*H[: t + 1])
        below = Add(*[g * H[g] for g in range(t + 1)])
        found += [
            Step(OMEGA[t], dark / N),
            Step(DARK[t], below / dark),
            Step(BRIGHT[t], (S - below) / (N - dark)),
            Step(B[t], OMEGA[t] * (1 - OMEGA[t]) * (DARK[t] - BRIGHT[t]) ** 2),
        ]
    return found


with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys(H, ""),
        steps=(Step(N, Add(*H)), Step(S, Add(*[g * H[g] for g in range(4)])), *steps()),
        traps={
            "not-squared": Step(B[1], OMEGA[1] * (1 - OMEGA[1]) * (BRIGHT[1] - DARK[1])),
            "one-share": Step(B[1], OMEGA[1] * (DARK[1] - BRIGHT[1]) ** 2),
            "shares-left-out": Step(B[1], (DARK[1] - BRIGHT[1]) ** 2),
            "counts-for-shares": Step(
                B[1], N**2 * OMEGA[1] * (1 - OMEGA[1]) * (DARK[1] - BRIGHT[1]) ** 2
            ),
        },
    )
