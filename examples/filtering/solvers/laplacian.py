"""Laplacian of a pixel from its four neighbours, and sharpening with it.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 3.6.
"""

from sympy import Add, evaluate, symbols

from quizgen.maths.model import Model, Step

F = symbols("f_1:10", integer=True)
L, h = symbols("L h", real=True)
f_1, f_2, f_3, f_4, f_5, f_6, f_7, f_8, f_9 = F

with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys(F, ""),
        steps=(Step(L, Add(f_2, f_4, f_6, f_8) - 4 * f_5), Step(h, f_5 - L)),
        traps={
            "eight-neighbours": Step(L, Add(f_1, f_2, f_3, f_4, f_6, f_7, f_8, f_9) - 8 * f_5),
            "sign-turned": Step(L, 4 * f_5 - Add(f_2, f_4, f_6, f_8)),
            "middle-once": Step(L, Add(f_2, f_4, f_6, f_8) - f_5),
            "divided": Step(L, (Add(f_2, f_4, f_6, f_8) - 4 * f_5) / 4),
            "added": Step(h, f_5 + L),
            "pixel-left-out": Step(h, -L),
        },
    )
