"""Magnification of a thin lens in close-up, its image distance, and where to stand for more.

Source: E. Hecht, Optics, 5th ed. (2017), section 5.2.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

f, z, n = symbols("f z n", positive=True)
m, image, second, z_2 = symbols("m z' m_2 z_2", real=True)

with evaluate(False):
    MODEL = Model(
        given={f: "mm", z: "mm", n: ""},
        steps=(
            Step(m, f / (z - f)),
            Step(image, f * (1 + m), "mm"),
            Step(second, n * m),
            Step(z_2, f * (1 + 1 / second), "mm"),
        ),
        formulas={"m": "F42", "z'": "F42", "z_2": "F42"},
        alternatives=(Step(image, m * z),),
        traps={
            "pinhole": Step(m, f / z),
            "inverted": Step(m, (z - f) / f),
            "signs-added": Step(m, f / (z + f)),
            "image-at-f": Step(image, f),
            "factor-alone": Step(image, f * m),
            "object-side": Step(image, f * (1 + 1 / m)),
            "in-proportion": Step(z_2, z / n),
            "image-side": Step(z_2, f * (1 + second)),
            "unchanged": Step(second, m),
            "from-focus": Step(z_2, f / second),
        },
    )
