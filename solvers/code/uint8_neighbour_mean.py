"""Mean of four 8-bit neighbours whose sum wraps at 256.

Source: NumPy reference, "Data type objects": unsigned integers wrap around.
"""

from sympy import Add, Integer, Mod, evaluate, symbols

from quizgen.maths.model import Model, Step

a, b, p, q = symbols("a b p q", integer=True)
s, w, c = symbols("s w c", real=True)

with evaluate(False):
    MODEL = Model(
        given={a: "", b: "", p: "", q: ""},
        steps=(Step(s, Add(a, b, p, q)), Step(w, Mod(s, 256)), Step(c, w / 4)),
        formulas={"w": "F36"},
        traps={
            "no-wrap": Step(w, s),
            "saturated": Step(w, Integer(255)),
            "not-divided": Step(c, w),
        },
    )
