"""Thin lens: image distance, magnification and focus travel; object and image distances positive.

Source: E. Hecht, Optics, 5th ed. (2017), section 5.2.
"""

from sympy import Rational, evaluate, symbols

from quizgen.maths.model import Model, Step

f, z = symbols("f z", positive=True)
q, image, m, travel = symbols("q z' m Delta", real=True)
PER_MILLIMETRE = Rational(1, 10**6)
"""A student who forgets to invert writes 1/mm as if it were mm: 1 mm^2 between the two."""

with evaluate(False):
    MODEL = Model(
        given={f: "mm", z: "mm"},
        steps=(
            Step(q, 1 / f - 1 / z, "1/mm"),
            Step(image, 1 / q, "mm"),
            Step(m, image / z),
            Step(travel, image - f, "mm"),
        ),
        formulas={"q": "F42", "z'": "F42", "m": "F42"},
        alternatives=(Step(travel, f * m),),
        traps={
            "image-at-f": Step(image, f),
            "signs-added": Step(image, 1 / (1 / f + 1 / z)),
            "difference": Step(image, z - f),
            "not-inverted": Step(image, q * PER_MILLIMETRE),
            "inverted-ratio": Step(m, z / image),
            "focal-over-object": Step(m, f / z),
            "travel-is-image": Step(travel, image),
        },
    )
