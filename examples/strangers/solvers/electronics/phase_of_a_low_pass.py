"""Phase of a low-pass filter: an angle of an inverse function, shown in degrees."""

from sympy import atan, evaluate, pi, symbols

from quizgen.maths.model import Model, Step

f, g, phi = symbols("f f_c phi")
with evaluate(False):
    MODEL = Model(
        given={f: "kHz", g: "Hz"},
        steps=(Step(phi, -(180 / pi) * atan(f / g), "°"),),
        traps={
            "inverse": Step(phi, -(180 / pi) * atan(g / f), "°"),
            "sign": Step(phi, (180 / pi) * atan(f / g), "°"),
        },
    )
