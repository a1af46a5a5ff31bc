"""Scale of a scene with some depth: at both ends, at the mean depth, and the error between them.

Source: R. Szeliski, Computer Vision, 2nd ed. (2022), section 2.1.4.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

f, z_1, z_2 = symbols("f z_1 z_2", positive=True)
s_1, s_2, zbar, s, epsilon = symbols("s_1 s_2 zbar s epsilon", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "m", z_1: "m", z_2: "m"},
        steps=(
            Step(s_1, f / z_1),
            Step(s_2, f / z_2),
            Step(zbar, (z_1 + z_2) / 2, "m"),
            Step(s, f / zbar),
            Step(epsilon, (s_1 - s) / s_1),
        ),
        formulas={"s": "F43", "epsilon": "F44", "s_1": "F05", "s_2": "F05"},
        alternatives=(Step(s, 2 * s_1 * s_2 / (s_1 + s_2)),),
        traps={
            "ends-exchanged": (Step(s_1, f / z_2), Step(s_2, f / z_1)),
            "ratio-inverted": (Step(s_1, z_1 / f), Step(s_2, z_2 / f), Step(s, zbar / f)),
            "sum-for-mean": Step(zbar, z_1 + z_2),
            "depth-range": Step(zbar, z_2 - z_1),
            "full-range": Step(epsilon, (z_2 - z_1) / zbar),
            "absolute-error": Step(epsilon, s_1 - s),
            "base-weak-scale": Step(epsilon, (s_1 - s) / s),
        },
    )
