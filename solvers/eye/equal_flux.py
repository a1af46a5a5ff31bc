"""The power at another wavelength that gives the same luminous flux, read from V or V'.

Source: CIE 018:2019, The Basis of Physical Photometry; K_m = 683 lm/W, K'_m = 1700 lm/W.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

P_1, h_1, h_2, K = symbols("P_1 h_1 h_2 K", positive=True)
here, width, peak = symbols("lambda_3 w lambda_p", positive=True)
P_2, flux, there = symbols("P_2 Phi lambda_4", positive=True)

with evaluate(False):
    MODEL = Model(
        given={P_1: "mW", h_1: "", h_2: "", K: "lm/W", here: "nm", width: "nm", peak: "nm"},
        steps=(
            Step(flux, K * P_1 * h_1, "lm"),
            Step(P_2, P_1 * (h_1 / h_2), "mW"),
            Step(there, here + width, "nm"),
        ),
        formulas={"Phi": "F03", "P_2": "F03"},
        alternatives=(Step(P_2, flux / (K * h_2)),),
        traps={
            "other-height": Step(flux, K * P_1 * h_2),
            "no-height": Step(flux, K * P_1),
            "divided-by-height": Step(flux, K * P_1 / h_1),
            "equal-power": Step(P_2, P_1),
            "upside-down": Step(P_2, P_1 * (h_2 / h_1)),
            "only-times": Step(P_2, P_1 * h_1),
            "only-divided": Step(P_2, P_1 / h_2),
            "mirrored": Step(there, 2 * peak - here),
        },
    )
