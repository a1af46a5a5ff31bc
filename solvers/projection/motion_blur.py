"""How many pixels something moves during an exposure, and the longest exposure for one pixel.

Source: R. Szeliski, Computer Vision, 2nd ed. (2022), section 2.1.4: x = f X / Z, with X = v t.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

f, v, t, Z = symbols("f v t Z", positive=True)
s, b, t_1 = symbols("s b t_1", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "px", v: "m/s", t: "ms", Z: "m"},
        steps=(
            Step(s, v * t, "mm"),
            Step(b, f * s / Z, "px"),
            Step(t_1, Z / (f * v), "ms"),
        ),
        formulas={"b": "F05", "t_1": "F10"},
        alternatives=(Step(t_1, t / b),),
        traps={
            "depth-left-out": Step(b, f * s),
            "depth-multiplies": Step(b, f * s * Z),
            "focal-length-left-out": Step(b, s / Z),
            "speed-divides": Step(s, t / v),
            "exposure-divides": Step(s, v / t),
            "no-depth-in-time": Step(t_1, 1 / (f * v)),
            "reciprocal": Step(t_1, f * v / Z),
            "blur-for-one-pixel": Step(t_1, t * b),
        },
    )
