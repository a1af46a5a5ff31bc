"""A value predicted by the line of least squares, from a summary of the data."""

from sympy import evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

m_x, m_y, v_x, v_y, r, x, b, a, y = symbols("m_x m_y v_x v_y r x b a y")
with evaluate(False):
    MODEL = Model(
        given={m_x: "", m_y: "", v_x: "", v_y: "", r: "", x: ""},
        steps=(
            Step(b, r * sqrt(v_y / v_x)),
            Step(a, m_y - b * m_x),
            Step(y, a + b * x),
        ),
        traps={
            "other-way-round": Step(b, r * sqrt(v_x / v_y)),
            "variances": Step(b, r * v_y / v_x),
            "no-intercept": Step(y, b * x),
        },
    )
