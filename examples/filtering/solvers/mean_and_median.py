"""Mean and median of nine grey values, given in their order of size.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 5.3.
"""

from sympy import Add, evaluate, symbols

from quizgen.maths.model import Model, Step

S = symbols("s_1:10", integer=True)
c = symbols("c", integer=True)
t, m, r = symbols("t m r", real=True)

with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys((*S, c), ""),
        steps=(Step(t, Add(*S)), Step(m, t / 9), Step(r, S[4])),
        traps={
            "middle-left-out": Step(m, (t - c) / 8),
            "outlier-left-out": Step(m, (t - S[8]) / 8),
            "divided-by-eight": Step(m, t / 8),
            "middle-pixel": Step(r, c),
            "middle-of-ends": Step(r, (S[0] + S[8]) / 2),
            "fourth": Step(r, S[3]),
            "sixth": Step(r, S[5]),
        },
    )
