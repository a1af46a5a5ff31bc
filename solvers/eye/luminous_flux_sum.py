"""Luminous flux of reflected light as a sum over five wavelength bands.

Source: CIE 018:2019, The Basis of Physical Photometry; V from the CIE 1924 table, K_m = 683 lm/W.
"""

from typing import Any

from sympy import Add, Integer, Rational, evaluate, symbols

from quizgen.maths.model import Model, Step

L = symbols("L_1:6", real=True)
R = symbols("R_1:6", real=True)
V = symbols("V_1:6", real=True)
K, w = symbols("K_m w", positive=True)
S, B = symbols("S B", real=True)
NANOMETRE, MILLIWATT_PER_NANOMETRE = Rational(1, 10**9), Integer(10**6)
"""Base units behind the numbers of a student who forgets a factor."""


def _sum(terms: list[Any]) -> Any:
    return Add(*terms, evaluate=False)


with evaluate(False):
    BANDS = list(zip(L, R, V, strict=True))
    MODEL = Model(
        given={
            **dict.fromkeys(L, "mW/nm"),
            **dict.fromkeys(R, ""),
            **dict.fromkeys(V, ""),
            K: "lm/W",
            w: "nm",
        },
        steps=(
            Step(S, _sum([a * b * c for a, b, c in BANDS]), "mW/nm"),
            Step(B, K * S * w, "lm"),
        ),
        formulas={"B": "F02", "S": "F02"},
        traps={
            "no-luminosity": Step(S, _sum([a * b for a, b, _ in BANDS])),
            "no-reflectance": Step(S, _sum([a * c for a, _, c in BANDS])),
            "reflectance-added": Step(
                S, _sum([(a + b * MILLIWATT_PER_NANOMETRE) * c for a, b, c in BANDS])
            ),
            "no-band-width": Step(B, K * S * NANOMETRE),
            "no-constant": Step(B, S * w),
        },
    )
