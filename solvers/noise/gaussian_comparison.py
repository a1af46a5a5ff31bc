"""Two normal noises with different standard deviations compared.

Source: Hogg, McKean & Craig, Introduction to Mathematical Statistics, section 3.4.
"""

from sympy import evaluate, pi, sqrt, symbols

from quizgen.maths.model import Model, Step

s_1, s_2 = symbols("sigma_1 sigma_2", positive=True)
q, g_1, g_2 = symbols("q g_1 g_2", positive=True)

with evaluate(False):
    MODEL = Model(
        given={s_1: "", s_2: ""},
        steps=(
            Step(g_1, 1 / (sqrt(2 * pi) * s_1)),
            Step(g_2, 1 / (sqrt(2 * pi) * s_2)),
            Step(q, s_2 / s_1),
        ),
        formulas={"g_1": "F16", "g_2": "F16"},
        traps={
            "upside-down": Step(q, s_1 / s_2),
            "variances": Step(q, s_2**2 / s_1**2),
            "root": Step(q, sqrt(s_2 / s_1)),
        },
    )
