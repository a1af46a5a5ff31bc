"""Flat-field correction of four pixels with truncation to 8 bits.

Source: R. C. Gonzalez, R. E. Woods, Digital Image Processing, 4th ed. (2018), section 2.6
(shading correction); NumPy's conversion to integers truncates.
"""

from sympy import Add, Max, Rational, evaluate, floor, symbols

from quizgen.maths.model import Model, Step

i = symbols("i_1:5", integer=True)
f = symbols("f_1:5", integer=True)
m = symbols("m", real=True)
o = symbols("o_1:5", integer=True)

with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys((*i, *f), ""),
        steps=(
            Step(m, Add(*f) / 4),
            *(Step(o[k], floor(i[k] * m / f[k])) for k in range(4)),
        ),
        formulas={"o_1": "F39", "o_2": "F39", "o_3": "F39", "o_4": "F39"},
        traps={
            "rounded": tuple(Step(o[k], floor(i[k] * m / f[k] + Rational(1, 2))) for k in range(4)),
            "multiplied": tuple(Step(o[k], floor(i[k] * f[k] / m)) for k in range(4)),
            "maximum-for-mean": Step(m, Max(*f)),
        },
    )
