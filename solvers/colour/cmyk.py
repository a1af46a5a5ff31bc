"""From RGB to the inks of a printer, without and with black.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 6.2.
"""

from sympy import Add, Max, Min, evaluate, symbols

from quizgen.maths.model import Model, Step

R, G, B = symbols("R G B", real=True)
C_0, M_0, Y_0, K, C, M, Y, saved = symbols("C_0 M_0 Y_0 K C M Y s", real=True)

with evaluate(False):
    MODEL = Model(
        given={R: "", G: "", B: ""},
        steps=(
            Step(C_0, 1 - R),
            Step(M_0, 1 - G),
            Step(Y_0, 1 - B),
            Step(K, 1 - Max(R, G, B)),
            Step(C, (C_0 - K) / (1 - K)),
            Step(M, (M_0 - K) / (1 - K)),
            Step(Y, (Y_0 - K) / (1 - K)),
            Step(saved, Add(C_0, M_0, Y_0) - Add(C, M, Y, K)),
        ),
        alternatives=(Step(K, Min(C_0, M_0, Y_0)),),
        traps={
            "not-complement": (Step(C_0, R), Step(M_0, G), Step(Y_0, B)),
            "black-of-least": Step(K, 1 - Min(R, G, B)),
            "largest-as-black": Step(K, Max(R, G, B)),
            "black-not-removed": (
                Step(C, C_0),
                Step(M, M_0),
                Step(Y, Y_0),
            ),
            "not-divided": (
                Step(C, C_0 - K),
                Step(M, M_0 - K),
                Step(Y, Y_0 - K),
            ),
            "divided-by-black": (
                Step(C, (C_0 - K) / K),
                Step(M, (M_0 - K) / K),
                Step(Y, (Y_0 - K) / K),
            ),
            "black-not-counted": Step(saved, Add(C_0, M_0, Y_0) - Add(C, M, Y)),
        },
    )
