"""Whether all fields of a part are filled in."""

from __future__ import annotations

import pytest

from quizgen.practice.boxes import filled
from quizgen.question.contract import LINE, Box, Control

TWO = Control("line", boxes=(Box(""), Box("")))


@pytest.mark.parametrize(
    ("control", "values", "marks", "right"),
    [
        (LINE, ["1"], (), True),
        (LINE, [" "], (), False),
        (LINE, [], (), False),
        (TWO, ["1", "2"], (), True),
        (TWO, ["1", ""], (), False),
        (TWO, ["1"], (), False),
        (Control("pairs"), ["1", "2"], "AB", True),
        (Control("pairs"), ["", "2"], "AB", False),
        (Control("order"), ["A", "", ""], (), True),
        (Control("order"), ["", ""], (), False),
        (Control("many", lines=0), ["B"], (), True),
        (Control("many", lines=0), [], (), False),
    ],
)
def test_filled(control, values, marks, right):
    assert filled(control, values, marks) is right
