"""Sum of two 8-bit numbers, taken modulo 256.

Source: NumPy reference, "Data type objects": unsigned integers wrap around.
"""

from sympy import Integer, Mod, evaluate, symbols

from quizgen.maths.model import Model, Step

a, b = symbols("a b", integer=True)
s, c = symbols("s c", integer=True)

with evaluate(False):
    MODEL = Model(
        given={a: "", b: ""},
        steps=(Step(s, a + b), Step(c, Mod(s, 256))),
        formulas={"c": "F36"},
        traps={
            "no-wrap": Step(c, s),
            "saturated": Step(c, Integer(255)),
            "modulo-255": Step(c, Mod(s, 255)),
        },
    )
