"""From RGB to hue, saturation and value on the hexagonal colour cone.

Source: A. R. Smith, "Color gamut transform pairs", SIGGRAPH 1978.
"""

from sympy import Eq, Max, Min, Piecewise, evaluate, symbols

from quizgen.maths.model import Model, Step

R, G, B = symbols("R G B", real=True)
V, m, Delta, S, H_0, H = symbols("V m Delta S H_0 H", real=True)

with evaluate(False):
    MODEL = Model(
        given={R: "", G: "", B: ""},
        steps=(
            Step(V, Max(R, G, B)),
            Step(m, Min(R, G, B)),
            Step(Delta, V - m),
            Step(S, Delta / V),
            Step(
                H_0,
                Piecewise(
                    (60 * ((G - B) / Delta), Eq(V, R)),
                    (60 * (2 + (B - R) / Delta), Eq(V, G)),
                    (60 * (4 + (R - G) / Delta), True),
                ),
                "deg",
            ),
            Step(H, Piecewise((H_0 + 360, H_0 < 0), (H_0, True)), "deg"),
        ),
        formulas={"V": "F23", "Delta": "F23", "S": "F23", "H_0": "F24"},
        traps={
            "difference-as-saturation": Step(S, Delta),
            "lightness-saturation": Step(S, Delta / (V + m)),
            "mean-as-value": Step(V, (R + G + B) / 3),
            "middle-as-value": (
                Step(V, (Max(R, G, B) + Min(R, G, B)) / 2),
                Step(Delta, 2 * V - 2 * m),
            ),
            "red-branch": Step(H_0, 60 * ((G - B) / Delta)),
            "next-branch": Step(
                H_0,
                Piecewise(
                    (60 * (2 + (G - B) / Delta), Eq(V, R)),
                    (60 * (4 + (B - R) / Delta), Eq(V, G)),
                    (60 * ((R - G) / Delta), True),
                ),
            ),
            "difference-swapped": Step(
                H_0,
                Piecewise(
                    (60 * ((B - G) / Delta), Eq(V, R)),
                    (60 * (2 + (R - B) / Delta), Eq(V, G)),
                    (60 * (4 + (G - R) / Delta), True),
                ),
            ),
            "negative-hue": Step(H, H_0),
            "half-degrees": Step(H, Piecewise((H_0 + 360, H_0 < 0), (H_0, True)) / 2),
            "full-turns": Step(H, Piecewise((H_0 + 360, H_0 < 0), (H_0, True)) / 360),
        },
    )
