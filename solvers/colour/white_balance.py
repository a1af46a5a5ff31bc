"""White balance by a grey card, and the chromaticity of a measured colour.

Source: G. Wyszecki, W. S. Stiles, Color Science, 2nd ed. (1982), section 3.2; R. W. G. Hunt, The
Reproduction of Colour, 6th ed. (2004), chapter 5.
"""

from sympy import Add, Max, evaluate, symbols

from quizgen.maths.model import Model, Step

R_c, G_c, B_c, R_p, B_p = symbols("R_c G_c B_c R_p B_p", positive=True)
X, Y, Z = symbols("X Y Z", positive=True)
g_R, g_B, red, blue, s, x, y = symbols("g_R g_B R'_p B'_p s x y", real=True)

with evaluate(False):
    MODEL = Model(
        given={R_c: "", G_c: "", B_c: "", R_p: "", B_p: "", X: "", Y: "", Z: ""},
        steps=(
            Step(g_R, G_c / R_c),
            Step(g_B, G_c / B_c),
            Step(red, g_R * R_p),
            Step(blue, g_B * B_p),
            Step(s, Add(X, Y, Z)),
            Step(x, X / s),
            Step(y, Y / s),
        ),
        traps={
            "gains-inverted": (Step(g_R, R_c / G_c), Step(g_B, B_c / G_c)),
            "gains-swapped": (Step(g_R, G_c / B_c), Step(g_B, G_c / R_c)),
            "gains-to-largest": (
                Step(g_R, Max(R_c, G_c, B_c) / R_c),
                Step(g_B, Max(R_c, G_c, B_c) / B_c),
            ),
            "added": (Step(red, R_p + (G_c - R_c)), Step(blue, B_p + (G_c - B_c))),
            "divided": (Step(red, R_p / g_R), Step(blue, B_p / g_B)),
            "third-left-out": Step(s, X + Y),
            "by-luminance": Step(s, Y),
            "by-largest": Step(s, Max(X, Y, Z)),
            "z-for-y": Step(y, Z / s),
        },
    )
