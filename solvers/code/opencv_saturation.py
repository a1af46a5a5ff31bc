"""OpenCV's sum and difference of 8-bit images, limited to 0 and 255.

Source: OpenCV documentation, "Operations with images": saturation arithmetic.
"""

from sympy import Max, Min, Mod, evaluate, symbols

from quizgen.maths.model import Model, Step

a, b, p, q = symbols("a b p q", integer=True)
u, v = symbols("u v", integer=True)

with evaluate(False):
    MODEL = Model(
        given={a: "", b: "", p: "", q: ""},
        steps=(Step(u, Min(255, a + b)), Step(v, Max(0, p - q))),
        formulas={"u": "F13", "v": "F13"},
        traps={
            "wrapped": (Step(u, Mod(a + b, 256)), Step(v, Mod(p - q, 256))),
            "unlimited": (Step(u, a + b), Step(v, p - q)),
            "absolute": Step(v, q - p),
        },
    )
