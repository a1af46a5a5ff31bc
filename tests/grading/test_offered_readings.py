"""What may have been meant by an answer asked back, as things to choose."""

from __future__ import annotations

import pytest

from quizgen.grading.offered_readings import choose_offered_reading, list_offered_readings
from quizgen.kinds.grade import grade_answer

NUMBER = {"kind": "number", "value": "1234", "rel": "0.001"}
FORMULA = {
    "kind": "expression",
    "value": "f*X/Z",
    "symbols": {"f": "positive", "X": "real", "Z": "positive"},
}


@pytest.mark.parametrize(
    ("spec", "typed", "labels"),
    [
        (NUMBER, "1,234", ["1.234", "1234"]),
        (NUMBER, "12 or 15", ["12", "15"]),
        (FORMULA, "X/Z f", ["X/Z*f", "X/(Z*f)"]),
        (NUMBER, "1234", []),
        (NUMBER, "?", []),
    ],
)
def test_readings_of_what_was_typed(spec, typed, labels):
    assert [one.label for one in list_offered_readings(grade_answer(spec, typed))] == labels


def test_thousands_are_chosen_by_the_decimal_sign():
    one, two = list_offered_readings(grade_answer(NUMBER, "1,234"))
    assert grade_answer(NUMBER, "1,234", decimal=one.decimal).verdict == "wrong"
    assert grade_answer(NUMBER, "1,234", decimal=two.decimal).verdict == "correct"


def test_a_reading_is_chosen_by_its_number_unless_that_is_a_reading():
    readings = list_offered_readings(grade_answer(NUMBER, "2 or 1"))
    assert [choose_offered_reading(readings, typed) for typed in ("1", "2", "3")] == [
        readings[1], readings[0], None
    ]  # fmt: skip
    first, second = readings = list_offered_readings(grade_answer(NUMBER, "12 or 15"))
    assert [choose_offered_reading(readings, typed) for typed in ("1", "2")] == [first, second]
