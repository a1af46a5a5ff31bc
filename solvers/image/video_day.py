"""Bytes of a video that runs for hours, raw and compressed."""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

W, H, f, h, c = symbols("W H f h c", positive=True)
q, S, C = symbols("q S C", positive=True)

with evaluate(False):
    MODEL = Model(
        given={W: "", H: "", f: "Hz", h: "s", c: ""},
        steps=(
            Step(q, 3 * W * H * f * 8, "Mbit/s"),
            Step(S, q * h, "GB"),
            Step(C, S / c, "GB"),
        ),
        formulas={"q": "F01"},
        traps={
            "one-channel": Step(q, W * H * f * 8),
            "bits-for-bytes": Step(S, 8 * q * h),
            "minutes-for-hours": Step(S, q * h / 60),
            "not-compressed": Step(C, S),
            "as-a-picture": Step(C, S / 10),
        },
    )
