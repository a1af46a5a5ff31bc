"""How many values each cell of an image holds, for four formats.

Source: Burger & Burge, Digital Image Processing, 2nd ed. (2016), section 1.3.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

c_1, c_2, c_3, c_4 = symbols("c_1:5", integer=True)
e_1, e_2, e_3, e_4 = symbols("e_1:5", integer=True)
y_1, y_2, y_3, y_4 = symbols("y_1:5", integer=True)
n_1, n_2, n_3, n_4 = symbols("n_1:5", integer=True)

with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys((c_1, c_2, c_3, c_4, e_1, e_2, e_3, e_4, y_1, y_2, y_3, y_4), ""),
        steps=(Step(n_1, c_1), Step(n_2, c_2), Step(n_3, c_3), Step(n_4, c_4)),
        traps={
            "fourth-left-out": (
                Step(n_1, e_1),
                Step(n_2, e_2),
                Step(n_3, e_3),
                Step(n_4, e_4),
            ),
            "raw-in-colour": (
                Step(n_1, y_1),
                Step(n_2, y_2),
                Step(n_3, y_3),
                Step(n_4, y_4),
            ),
        },
    )
