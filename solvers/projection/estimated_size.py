"""Size of the image of a thing that is far away, in pixels, from size over distance."""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

q, f, p, a = symbols("q f p a", positive=True)
y, n = symbols("y' n", positive=True)

with evaluate(False):
    MODEL = Model(
        given={q: "", f: "mm", p: "um", a: ""},
        steps=(
            Step(y, f * q, "mm"),
            Step(n, y / p),
        ),
        formulas={"y'": "F05"},
        traps={
            "degrees": Step(y, f * a),
            "from-the-middle": Step(y, f * q / 2),
            "inverted": Step(n, p / y),
        },
    )
