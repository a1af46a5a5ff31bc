"""Eight-bit arithmetic that wraps around, and the memory that floats cost instead.

Source: NumPy manual, array scalars and overflow: unsigned integers count modulo 2^8.
"""

from sympy import Mod, evaluate, symbols

from quizgen.maths.model import Model, Step

a, b, c, d, W, H = symbols("a b c d W H", integer=True)
s, u, e, v, n, m = symbols("s u e v n M", integer=True)

with evaluate(False):
    MODEL = Model(
        given={a: "", b: "", c: "", d: "", W: "", H: ""},
        steps=(
            Step(s, a + b),
            Step(u, Mod(s, 256)),
            Step(e, c - d),
            Step(v, Mod(e, 256)),
            Step(n, 3 * W * H),
            Step(m, 4 * n),
        ),
        formulas={"u": "F36", "v": "F36", "n": "F01"},
        traps={
            "not-wrapped": (Step(u, s), Step(v, e)),
            "saturated": (Step(u, 255), Step(v, 0)),
            "modulo-255": (Step(u, Mod(s, 255)), Step(v, Mod(e, 255))),
            "sign-dropped": Step(v, d - c),
            "one-byte": Step(m, n),
            "bits-for-bytes": Step(m, 32 * n),
            "double-precision": Step(m, 8 * n),
        },
    )
