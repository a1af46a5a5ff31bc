"""From hue, saturation and value back to RGB: the recipe with chroma C, second channel X, floor m.

Source: A. R. Smith, "Color gamut transform pairs", SIGGRAPH 1978.
"""

from typing import Any

from sympy import Abs, Mod, Or, Piecewise, evaluate, symbols

from quizgen.maths.model import Model, Step

H, S, V = symbols("H S V", real=True)
C, h, X, m, R, G, B = symbols("C h X m R G B", real=True)


def _channels(high: Any, middle: Any, low: Any) -> tuple[Step, Step, Step]:
    """R, G and B for the six sectors of the colour circle."""
    return (
        Step(R, Piecewise((high, Or(h < 1, h >= 5)), (middle, Or(h < 2, h >= 4)), (low, True))),
        Step(G, Piecewise((middle, h < 1), (high, h < 3), (middle, h < 4), (low, True))),
        Step(B, Piecewise((low, h < 2), (middle, h < 3), (high, h < 5), (middle, True))),
    )


def _channels_of_next_sector(high: Any, middle: Any, low: Any) -> tuple[Step, Step, Step]:
    """The same with the sectors counted one too far."""
    return (
        Step(R, Piecewise((middle, h < 1), (low, h < 3), (middle, h < 4), (high, True))),
        Step(G, Piecewise((high, h < 2), (middle, h < 3), (low, h < 5), (middle, True))),
        Step(
            B,
            Piecewise((low, h < 1), (middle, h < 2), (high, h < 4), (middle, h < 5), (low, True)),
        ),
    )


with evaluate(False):
    MODEL = Model(
        given={H: "deg", S: "", V: ""},
        steps=(
            Step(C, V * S),
            Step(h, H / 60),
            Step(X, C * (1 - Abs(Mod(h, 2) - 1))),
            Step(m, V - C),
            *_channels(C + m, X + m, 0 + m),
        ),
        formulas={"C": "F25", "X": "F25", "m": "F25", "R": "F26", "G": "F26", "B": "F26"},
        traps={
            "next-sector": _channels_of_next_sector(C + m, X + m, 0 + m),
            "no-absolute-value": Step(X, C * (1 - (Mod(h, 2) - 1))),
            "floor-left-out": _channels(C, X, 0 * C),
            "no-modulo": Step(X, C * (1 - Abs(h - 1))),
            "hue-over-360": Step(h, H / 360),
        },
    )
