"""Data rate of a video: raw mosaic, colour after demosaicing, and how long a card lasts.

Source: Nakamura (ed.), Image Sensors and Signal Processing (2006), chapter 9.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

W, H, b, f, S = symbols("W H b f S", positive=True)
raw, colour, t = symbols("q_r q_c t", positive=True)

with evaluate(False):
    MODEL = Model(
        given={W: "", H: "", b: "bit", f: "Hz", S: "GB"},
        steps=(
            Step(raw, W * H * b * f, "Gbit/s"),
            Step(colour, 3 * W * H * 8 * f, "MB/s"),
            Step(t, S / raw, "s"),
        ),
        formulas={"q_r": "F01", "q_c": "F01"},
        alternatives=(Step(colour, raw * 3 * 8 / b),),
        traps={
            "three-for-raw": Step(raw, 3 * W * H * b * f),
            "bytes-for-bits": Step(raw, W * H * b * f / 8),
            "eight-bits": Step(raw, W * H * 8 * f),
            "edges-added": Step(raw, (W + H) * b * f),
            "one-channel": Step(colour, W * H * 8 * f),
            "raw-depth": Step(colour, 3 * W * H * b * f),
            "bits-as-bytes": Step(colour, 3 * W * H * 64 * f),
            "card-in-bits": Step(t, S / (8 * raw)),
            "colour-on-card": Step(t, S / colour),
        },
    )
