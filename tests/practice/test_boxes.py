"""Fields of a part: whether all are filled in, and which one a column of their line is in."""

from __future__ import annotations

from sweep import together

from quizgen.kinds.contract import LINE, InputBox, InputControl
from quizgen.practice.input_fields import is_complete, join_fields, locate_in_fields

TWO = InputControl("line", boxes=(InputBox(""), InputBox("")))


@together(
    ("control", "values", "marks", "right"),
    [
        (LINE, ["1"], (), True),
        (LINE, [" "], (), False),
        (LINE, [], (), False),
        (TWO, ["1", "2"], (), True),
        (TWO, ["1", ""], (), False),
        (TWO, ["1"], (), False),
        (InputControl("pairs"), ["1", "2"], "AB", True),
        (InputControl("pairs"), ["", "2"], "AB", False),
        (InputControl("order"), ["A", "", ""], (), True),
        (InputControl("order"), ["", ""], (), False),
        (InputControl("many", lines=0), ["B"], (), True),
        (InputControl("many", lines=0), [], (), False),
    ],
)
def test_filled(control, values, marks, right):
    assert is_complete(control, values, marks) is right


NAMED = InputControl("line", boxes=(InputBox("V"), InputBox("S"), InputBox("H")), named=True)


@together(
    ("control", "values", "marked"),
    [
        (TWO, ["1", "?"], (1, 1)),
        (TWO, ["?", "1"], (0, 1)),
        (TWO, ["12", "  3?4"], (1, 4)),
        (TWO, ["1+?", "2"], (0, 3)),
        (NAMED, ["1", "2?", "3"], (1, 2)),
        (NAMED, ["", " 2", "3 ?"], (2, 3)),
    ],
)
def test_a_column_of_the_joined_line_is_found_in_its_field(control, values, marked):
    line = join_fields(control, values)
    assert locate_in_fields(control, values, line.index("?") + 1) == marked


def test_what_is_before_or_behind_a_value_belongs_to_it():
    line = join_fields(NAMED, ["1", "2", "3"])
    assert line == "V = 1; S = 2; H = 3"
    assert locate_in_fields(NAMED, ["1", "2", "3"], line.index("S") + 1) == (1, 1)
    assert locate_in_fields(NAMED, ["1", "2", "3"], len(line) + 1) == (2, 2)
