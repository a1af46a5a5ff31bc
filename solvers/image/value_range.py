"""Levels, largest value and size of a pixel value for the usual number types of images.

Source: NumPy manual, data types; section 2.3 of the notes.
"""

from sympy import Mod, Piecewise, evaluate, symbols

from quizgen.maths.model import Model, Step

b, a = symbols("b a", integer=True)
levels, largest, size, after = symbols("L M B A", integer=True)

with evaluate(False):
    MODEL = Model(
        given={b: "", a: ""},
        steps=(
            Step(levels, 2**b),
            Step(largest, levels - 1),
            Step(size, Piecewise((1, b <= 8), (2, b <= 16), (4, True))),
            Step(after, Mod(largest + a, levels)),
        ),
        formulas={"L": "F01", "A": "F36"},
        traps={
            "levels-for-largest": Step(largest, levels),
            "largest-for-levels": (Step(levels, 2**b - 1), Step(largest, 2**b - 1)),
            "twice-the-bits": (Step(levels, 2 * b), Step(largest, 2 * b - 1)),
            "bits-for-bytes": Step(size, b),
            "bits-over-eight": Step(size, b / 8),
            "saturated": Step(after, largest),
            "not-wrapped": Step(after, largest + a),
            "off-by-one": Step(after, Mod(largest + a, levels) + 1),
        },
    )
