"""Initial vertical speed and time of flight of a throw from a roof."""

from sympy import cos, evaluate, pi, sin, sqrt, symbols, tan

from quizgen.maths.model import Model, Step

m, h, v, alpha, g, w, t = symbols("m h v alpha g w t")
with evaluate(False):
    MODEL = Model(
        given={m: "kg", h: "m", v: "m/s", alpha: "", g: "m/s^2"},
        steps=(
            Step(w, v * sin(alpha * pi / 180), "m/s"),
            Step(t, (w + sqrt(w**2 + 2 * g * h)) / g, "s"),
        ),
        traps={
            "horizontal": Step(w, v * cos(alpha * pi / 180), "m/s"),
            "whole-speed": Step(w, 1 * v, "m/s"),
            "tangent": Step(w, v * tan(alpha * pi / 180), "m/s"),
            "from-the-ground": Step(t, 2 * w / g, "s"),
            "dropped": Step(t, sqrt(2 * h / g), "s"),
            "upwards-only": Step(t, w / g, "s"),
        },
    )
