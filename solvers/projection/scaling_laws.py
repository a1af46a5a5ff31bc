"""How the image scales when depth, focal length and object size are multiplied.

Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), eq. 6.1: x = f X / Z.
"""

from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

a, b, c, h_0 = symbols("a b c h_0", positive=True)
q, h_1 = symbols("q h_1", positive=True)

with evaluate(False):
    MODEL = Model(
        given={a: "", b: "", c: "", h_0: "mm"},
        steps=(Step(q, b * c / a), Step(h_1, q * h_0, "mm")),
        formulas={"q": "F07", "h_1": "F07"},
        traps={
            "depth-multiplies": Step(q, a * b * c),
            "upside-down": Step(q, a / (b * c)),
            "forgot-size": Step(q, b / a),
            "forgot-focal-length": Step(q, c / a),
            "forgot-depth": Step(q, b * c),
            "size-divides": Step(q, b / (a * c)),
            "divided-by-factor": Step(h_1, h_0 / q),
        },
    )
