"""What a line may not separate: a formula and what is said of it right behind."""

from __future__ import annotations

from sweep import together

from quizgen import typeset
from quizgen.maths.notation import parse_formula
from quizgen.question.interpolation import inlines_to_text, unbreakable_groups
from quizgen.typeset.prose import PlainText, TypesetMaths


def maths(text):
    return TypesetMaths(typeset.lay_out(parse_formula(text)), text)


@together(
    ("parts", "pieces"),
    [
        (
            (maths("f"), PlainText(" = "), PlainText("6\u00a0mm"), PlainText(" and")),
            ["f = 6\u00a0mm", " and"],
        ),
        ((PlainText("at "), maths("z"), PlainText(", the")), ["at ", "z,", " the"]),
        ((maths("u"), PlainText(" = "), maths("v"), PlainText(". So")), ["u = v.", " So"]),
        ((maths("u"), maths("v")), ["u", "v"]),
        ((maths("u"), PlainText(" and "), maths("v")), ["u", " and ", "v"]),
        ((maths("x^2 + y^2 + z^2 + w^2"), PlainText(" = 3")), ["x² + y² + z² + w²", " = 3"]),
        ((), []),
    ],
)
def test_a_formula_keeps_what_belongs_to_it(parts, pieces):
    assert [inlines_to_text(group) for group in unbreakable_groups(parts)] == pieces
