"""Infrared that passes the dye of a green photosite, weighed as silicon weighs it.

Source: J. Nakamura (ed.), Image Sensors and Signal Processing for Digital Still Cameras (2006),
chapter 3: colour filters and the filter against infrared.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

P_g, P_i, t_g, t_i, e_g, e_i, T_1 = symbols("P_g P_i t_g t_i e_g e_i T_1", positive=True)
s_g, s_i, s, x, T_2 = symbols("s_g s_i s x T_2", real=True)

with evaluate(False):
    MODEL = Model(
        given={P_g: "mW", P_i: "mW", t_g: "%", t_i: "%", e_g: "", e_i: "", T_1: "ms"},
        steps=(
            Step(s_g, P_g * t_g * e_g, "mW"),
            Step(s_i, P_i * t_i * e_i, "mW"),
            Step(s, s_g + s_i, "mW"),
            Step(x, s_i / s, "%"),
            Step(T_2, T_1 * (s_g / s), "ms"),
        ),
        alternatives=(
            Step(x, 1 - s_g / s),
            Step(T_2, T_1 * (1 - x)),
        ),
        traps={
            "silicon-left-out": (Step(s_g, P_g * t_g, "mW"), Step(s_i, P_i * t_i, "mW")),
            "dye-left-out": (Step(s_g, P_g * e_g, "mW"), Step(s_i, P_i * e_i, "mW")),
            "infrared-alone": Step(s, s_i, "mW"),
            "over-green": Step(x, s_i / s_g, "%"),
            "green-share": Step(x, s_g / s, "%"),
            "longer": Step(T_2, T_1 * (s / s_g), "ms"),
            "by-infrared": Step(T_2, T_1 * (s_i / s), "ms"),
        },
    )
