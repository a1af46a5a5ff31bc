"""One grey level under three edits: fewer levels, a squeezed range, a clamped shift.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), sections 2.4 and 3.2.
"""

from sympy import Min, evaluate, floor, log, symbols

from quizgen.maths.model import Model, Step

before, n, low, high, s = symbols("I n a b s", positive=True)
bits, k, coarse, squeezed, bright = symbols("B k I_n I_r I_s", real=True)

with evaluate(False):
    MODEL = Model(
        given={before: "", n: "", low: "", high: "", s: ""},
        steps=(
            Step(bits, log(n, 2)),
            Step(k, floor(before / 255 * (n - 1) + 1 / 2)),
            Step(coarse, 255 * (k / (n - 1))),
            Step(squeezed, low + (high - low) * (before / 255)),
            Step(bright, Min(before + s, 255)),
        ),
        formulas={"B": "F01", "I_r": "F11", "I_s": "F13"},
        traps={
            "bars-for-bits": Step(bits, n),
            "down": Step(k, floor(before / 255 * (n - 1))),
            "times-levels": Step(coarse, 256 * (k / n)),
            "index-for-level": Step(coarse, k),
            "start-forgotten": Step(squeezed, (high - low) * (before / 255)),
            "whole-range": Step(squeezed, low + high * (before / 255)),
            "clamped-to-range": Step(squeezed, Min(before, high)),
            "not-clamped": Step(bright, before + s),
            "wrapped": Step(bright, before + s - 256 * floor((before + s) / 256)),
        },
    )
