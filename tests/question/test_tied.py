"""What a line may not separate: a formula and what is said of it right behind."""

from __future__ import annotations

import pytest

from quizgen import typeset
from quizgen.bank.prose import Words
from quizgen.maths.notation import parse
from quizgen.question.filling import plain, tied
from quizgen.question.shown import Maths


def maths(text):
    return Maths(typeset.layout(parse(text)), text)


@pytest.mark.parametrize(
    ("parts", "pieces"),
    [
        ((maths("f"), Words(" = "), Words("6\u00a0mm"), Words(" and")), ["f = 6\u00a0mm", " and"]),
        ((Words("at "), maths("z"), Words(", the")), ["at ", "z,", " the"]),
        ((maths("u"), Words(" = "), maths("v"), Words(". So")), ["u = v.", " So"]),
        ((maths("u"), maths("v")), ["u", "v"]),
        ((maths("u"), Words(" and "), maths("v")), ["u", " and ", "v"]),
        ((maths("x^2 + y^2 + z^2 + w^2"), Words(" = 3")), ["x² + y² + z² + w²", " = 3"]),
        ((), []),
    ],
)
def test_a_formula_keeps_what_belongs_to_it(parts, pieces):
    assert [plain(group) for group in tied(parts)] == pieces
