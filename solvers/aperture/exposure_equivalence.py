"""Exposure time that keeps a picture as bright at another f-number and another ISO value.

Source: S. J. Ray, Applied Photographic Optics, 3rd ed. (2002), chapter 12: H ~ t S/N^2.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

N_1, N_2, S_1, S_2, r = symbols("N_1 N_2 S_1 S_2 r", positive=True)
q_n, q_s, t_1, t_2 = symbols("q_N q_S t_1 t_2", positive=True)

with evaluate(False):
    MODEL = Model(
        given={N_1: "", N_2: "", S_1: "", S_2: "", r: ""},
        steps=(
            Step(q_n, (N_2 / N_1) ** 2),
            Step(q_s, S_1 / S_2),
            Step(t_1, 1 / r, "s"),
            Step(t_2, t_1 * q_n * q_s, "s"),
        ),
        formulas={"q_N": "F35"},
        traps={
            "not-squared": Step(q_n, N_2 / N_1),
            "wrong-way": Step(q_n, (N_1 / N_2) ** 2),
            "doubled": Step(q_n, 2 * (N_2 / N_1)),
            "iso-inverted": Step(t_2, t_1 * q_n / q_s),
            "iso-forgotten": Step(t_2, t_1 * q_n),
            "number-forgotten": Step(t_2, t_1 * q_s),
            "iso-squared": Step(t_2, t_1 * q_n * q_s**2),
        },
    )
