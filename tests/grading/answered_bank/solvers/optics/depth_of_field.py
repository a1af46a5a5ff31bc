"""Hyperfocal distance, the limits of the depth of field, and how it splits before and behind.

Source: S. J. Ray, Applied Photographic Optics, 3rd ed. (2002), chapter 22; thin lens, exact.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

f, N, c, s = symbols("f N c s", positive=True)
H, near, far, T, front, rear, q = symbols("H z_n z_f T d_n d_f q", real=True)

with evaluate(False):
    NEAR = s * (H - f) / (H + s - 2 * f)
    FAR = s * (H - f) / (H - s)
    MODEL = Model(
        given={f: "mm", N: "", c: "um", s: "m"},
        steps=(
            Step(H, f**2 / (N * c) + f, "m"),
            Step(near, NEAR, "m"),
            Step(far, FAR, "m"),
            Step(T, far - near, "m"),
            Step(front, s - near, "m"),
            Step(rear, far - s, "m"),
            Step(q, rear / front),
        ),
        traps={
            "not-squared": Step(H, f / (N * c)),
            "number-forgotten": Step(H, f**2 / c + f),
            "times-number": Step(H, N * f**2 / c + f),
            "exchanged": (Step(near, FAR), Step(far, NEAR)),
            "swapped": (Step(front, far - s, "m"), Step(rear, s - near, "m")),
            "half-hyperfocal": Step(near, H / 2),
            "mirrored": Step(far, 2 * s - near),
            "front-only": Step(T, s - near),
            "rear-only": Step(T, far - s),
            "added": Step(T, far + near),
            "inverted": Step(q, front / rear),
            "third-rule": Step(q, 2),
            "half-rule": Step(q, 1),
        },
    )
