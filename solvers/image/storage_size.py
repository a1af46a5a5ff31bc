"""Stored values and bytes of an uncompressed image.

Source: Burger & Burge, Digital Image Processing, 2nd ed. (2016), section 1.3, table 1.1.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

W, H, C, b, c_e = symbols("W H C b c_e", integer=True)
n, bits, size = symbols("n Q M", integer=True)

with evaluate(False):
    MODEL = Model(
        given={W: "", H: "", C: "", b: "bit", c_e: ""},
        steps=(Step(n, W * H * C), Step(bits, n * b, "bit"), Step(size, bits, "B")),
        formulas={"n": "F01", "Q": "F01"},
        traps={
            "channels-left-out": Step(n, W * H),
            "other-channels": Step(n, W * H * c_e),
            "edges-added": Step(n, (W + H) * C),
            "bits-for-bytes": Step(size, 8 * bits),
            "bytes-per-value": Step(size, n * 8),
            "levels-for-bits": Step(bits, n * 2**b),
        },
    )
