"""Mean of two 8-bit numbers whose sum wraps before the division.

Source: NumPy reference, "Data type objects": unsigned integers wrap around.
"""

from sympy import Integer, Mod, evaluate, floor, symbols

from quizgen.maths.model import Model, Step

a, b = symbols("a b", integer=True)
s, w, c = symbols("s w c", integer=True)

with evaluate(False):
    MODEL = Model(
        given={a: "", b: ""},
        steps=(Step(s, a + b), Step(w, Mod(s, 256)), Step(c, floor(w / 2))),
        formulas={"w": "F36"},
        traps={
            "no-wrap": Step(w, s),
            "saturated": Step(w, Integer(255)),
            "not-halved": Step(c, w),
        },
    )
