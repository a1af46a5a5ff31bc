"""What is printed for people is read when it is typed, and what is said is written for them."""

from __future__ import annotations

import pytest
from sweep import together

from quizgen.grading.feedback import feedback_sentence
from quizgen.kinds.grade import grade_answer, show_key

GAP = "\N{NARROW NO-BREAK SPACE}"
BYTES = {"kind": "quantity", "value": "1228800", "unit": "B"}
NAMED = {"kind": "table", "values": {"N_b": "16000", "p'_x": "-12345.5", "n_1": "1/20000"}}
POINT = {"kind": "point", "values": ["27000", "-12345.25"]}


@together("decimal", ["auto", "point", "comma"])
@together("gap", [GAP, "\N{NO-BREAK SPACE}", " ", "\N{THIN SPACE}"])
def test_groups_of_digits_are_read(gap, decimal):
    assert grade_answer(BYTES, f"1{gap}228{gap}800 B", decimal=decimal).verdict == "correct"
    assert (
        grade_answer(POINT, f"(27{gap}000; −12{gap}345.25)", decimal=decimal).verdict == "correct"
    )


@together("decimal", ["auto", "point", "comma"])
@together("typed", ["2.2·10⁻⁴¹", "2,2·10⁻⁴¹", "2.2 · 10⁻⁴¹"])
def test_powers_of_ten_are_read(typed, decimal):
    verdict = grade_answer({"kind": "number", "value": "2.2e-41"}, typed, decimal=decimal)
    assert (verdict.verdict, verdict.read_as) == ("correct", "2.2·10⁻⁴¹")


@together("decimal", ["auto", "point"])
@together("kind", [BYTES, NAMED, POINT])
def test_what_is_shown_is_read_back(kind, decimal):
    assert grade_answer(kind, show_key(kind), decimal=decimal).verdict == "correct"


def test_keys_are_shown_as_people_write_them():
    assert show_key(BYTES) == f"1{GAP}228{GAP}800 B"
    assert show_key(NAMED) == f"N_b = 16{GAP}000; p′ₓ = −12{GAP}345.5; n₁ = 5·10⁻⁵"
    assert show_key({"kind": "number", "value": "-27"}) == "−27"


@pytest.mark.parametrize(
    ("rule", "shown"),
    [({"rel": "0.01"}, f"96{GAP}000{GAP}000"), ({"sigfigs": 4}, f"96{GAP}000{GAP}000"),
     ({"sigfigs": 4, "strict": True}, "9.600·10⁷"), ({"sigfigs": 1}, "1·10⁸")],
)  # fmt: skip
def test_whole_numbers_are_written_out_where_they_say_what_is_asked(rule, shown):
    assert show_key({"kind": "number", "value": "96000000", **rule}) == shown


def test_a_number_in_a_gap_is_shown_as_the_number():
    spec = {"kind": "gap", "accept": [["507", "507 nm", "507 ন্যানোমিটার"], ["rods", "রড"]]}
    assert show_key(spec, "bn") == "507; রড"
    assert show_key(spec, "en") == "507; rods"


SYMBOLS = dict.fromkeys(["f", "p'_x", "p'_y", "p_z", "k1", "sigma_1"], "positive")


@pytest.mark.parametrize(
    "value",
    ["f*p'_x/p_z + k1 - p'_y", "exp(-f^2/(2*sigma_1^2))", "sqrt(12345*f) - log2(p_z)",
     "pi*k1^(-2) + log10(f)^2", "f^(1/2)/20000"],
)  # fmt: skip
def test_formulas_are_read_back(value):
    spec = {"kind": "expression", "value": value, "symbols": SYMBOLS}
    shown = show_key(spec)
    assert not set(shown) & set("*'-")
    verdict = grade_answer(spec, shown)
    assert (verdict.verdict, verdict.read_as) == ("correct", shown)


def test_messages_name_quantities_and_powers_as_they_are_written():
    assert grade_answer(NAMED, f"16{GAP}000; 1; 5·10⁻⁵").message == "Not right: p′ₓ."
    assert grade_answer({"kind": "number", "value": "5"}, "5000").message.endswith(": 10³.")
    assert "p_z" in feedback_sentence("bn", "operator", {"detail": "p_z"})
    assert "k₁ / p′ₓ" in feedback_sentence("en", "wrong-parameter", {"detail": "k_1 / p'_x"})
