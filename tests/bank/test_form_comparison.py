"""Whether a mistake is the key in another form: then the draw is thrown away."""

from __future__ import annotations

from sweep import together

from quizgen.bank.form_comparison import forms_agree
from quizgen.maths.notation import parse_formula
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.tree import Call


@together(
    ("first", "second", "same"),
    [
        ("x < 3", "3 > x", True),
        ("x < 3", "2x < 6", True),
        ("x < 3", "x > 3", False),
        ("x < 3", "x <= 3", False),
        ("x <= 3", "0 <= 3 - x", True),
        ("x - y < 3", "y - x < 3", False),
    ],
)
def test_an_inequality_may_be_turned_and_multiplied_and_not_reversed(first, second, same):
    assert forms_agree(parse_formula(first), parse_formula(second)) is same


@together(("second", "same"), [("0.34", True), ("0.3499", True), ("0.36", False)])
def test_numbers_that_are_asked_to_two_decimals_are_apart_by_two_of_them(second, same):
    forms = [Call("vector", (parse_formula(x), parse_formula("1"))) for x in ("1/3", second)]
    assert forms_agree(*forms, rule=Tolerance(decimals=2)) is same
    assert not forms_agree(*forms)
