"""Numbers as figures print them."""

from __future__ import annotations

import pytest

from quizgen.figures._numbers import derived, equation, given, numbered


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (200 / 3, "66.67"),
        (2.5, "2.5"),
        (-0.8, "−0.8"),
        (1e-05, "0.00001"),
        (2699.8, "2700"),
        (0.00125, "0.00125"),
        (1.0005, "1.001"),
        (-66.665, "−66.67"),
        (0.0, "0"),
        (5535.0, "5535"),
    ],
)
def test_numbers_are_rounded_half_away_from_zero(value, text):
    assert derived(value) == text


def test_equations_say_whether_they_are_exact():
    assert equation("x", 115.0) == "x = 115"
    assert equation("x", 20 / 3, "mm") == "x ≈ 6.667 {mm}"
    assert equation("x", 20 / 3, "mm", hide=True) == "x = ?"
    assert given(1234567.0) == "1234567"
    assert given(0.1 + 0.2) == "0.3"
    assert equation("x", 12345.0) == "x = 12345"


def test_captions_tell_only_the_number_in_a_quiz():
    assert numbered(2, "I + 60", quiz=True) == "{2}"
    assert numbered(2, "I + 60", quiz=False) == "{2:}  I + 60"
