"""What is said about one number: the echo, the digits asked and given, the slip that explains it."""

from __future__ import annotations

from fractions import Fraction

import pytest
from flint import fmpq
from sweep import together

from quizgen.grading.diagnosis.numeric_slips import (
    agrees_within_half_percent,
    find_common_slip,
    is_in_radians,
    power_of_ten_off,
)
from quizgen.grading.options import QuestionContext
from quizgen.grading.verdict import Verdict
from quizgen.kinds.grade import grade_answer
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse_formula

HALF = Fraction(1, 2)
FIGURES = {"kind": "number", "value": "12.25", "sigfigs": 4}
PLACES = {"kind": "number", "value": "12.25", "decimals": 2}


@together(
    ("spec", "typed", "note", "credit", "fields"),
    [
        (FIGURES, "12.25", "", 1, {}),
        (FIGURES, "49/4", "", 1, {}),
        (FIGURES, "12.250", "more-digits", 1, {}),
        (FIGURES, "12.3", "figures-asked", HALF, {"asked": 4, "given": 3}),
        ({**FIGURES, "value": "12"}, "12", "figures-asked", HALF, {"asked": 4, "given": 2}),
        ({**FIGURES, "strict": True}, "12.250", "figures-unclear", HALF, {"asked": 4}),
        (PLACES, "12.25", "", 1, {}),
        (PLACES, "12.3", "decimals-asked", HALF, {"asked": 2}),
        ({**PLACES, "strict": True}, "12.250", "decimals-asked", HALF, {"asked": 2}),
        ({**PLACES, "strict": True}, "49/4", "", 1, {}),
        ({"kind": "number", "value": "12.25", "exact": True}, "12.3", "exact-wanted", HALF, {}),
    ],
)
def test_digits_asked_and_given_are_told(spec, typed, note, credit, fields):
    found = grade_answer(spec, typed)
    assert (found.note, found.credit, dict(found.fields)) == (note, credit, fields)
    assert found.read_as == typed


def test_a_whole_number_as_a_decimal_is_read_as_typed():
    found = grade_answer({"kind": "number", "value": "2", "exact": True}, "2.001")
    assert (found.verdict, found.note, found.read_as) == ("correct", "whole-number", "2.001")


@pytest.mark.parametrize(
    ("value", "typed", "credit"),
    [
        ("2", "2.01", 1),
        ("2", "1.99", 1),
        ("2", "2.0101", 0),
        ("0", "0.001", 0),
        ("5/2", "2.501", 0),
    ],
)
def test_a_whole_number_is_meant_within_a_hundredth(value, typed, credit):
    assert grade_answer({"kind": "number", "value": value, "exact": True}, typed).credit == credit


@pytest.mark.parametrize("typed", ["5", "5.01", "5.02"])
def test_the_nearest_of_several_known_mistakes_is_named(typed):
    """All three lie within half a percent of one another."""
    spec = {"kind": "number", "value": "10", "traps": {"5": "5", "5.01": "5.01", "5.02": "5.02"}}
    found = grade_answer(spec, typed)
    assert (found.note, found.read_as) == (f"trap:{typed}", typed)


def test_the_first_of_two_equal_mistakes_is_named():
    spec = {"kind": "number", "value": "10", "traps": {"first": "5", "second": "5"}}
    assert grade_answer(spec, "5").note == "trap:first"


@pytest.mark.parametrize("typed", ["123.456", "+123.456", "-123.456"])
def test_both_readings_are_echoed(typed):
    value = "-123456" if typed[0] == "-" else "123456"
    found = grade_answer({"kind": "number", "value": value, "exact": True}, typed)
    sign = typed[0].strip("+1")
    sign = sign.replace("-", "−")
    first, second = f"{sign}123.456", f"{sign}123\u202f456"
    assert (found.verdict, found.note) == ("ambiguous", "two-readings")
    assert dict(found.fields) == {"first": first, "second": second}
    assert found.read_as == f"{first} | {second}"


@together(
    ("key", "typed", "note"),
    [
        ("3", "-3", "sign"),
        ("1", "100", "percent-slip"),
        ("1/2", "50", "percent-slip"),
        ("3/2", "150", "power-of-ten"),
        ("4", "1/4", "reciprocal"),
        ("3", "-300", "sign-and-power"),
        ("3", "12", "factor"),
        ("3", "0", ""),
    ],
)
def test_a_slip_in_one_number_alone_is_named(key, typed, note):
    found = grade_answer({"kind": "number", "value": key}, typed)
    assert (found.note, found.credit, found.read_as) == (note, 0, typed.replace("-", "−"))


@together(
    ("value", "power"),
    [(fmpq(10) ** 18, 18), (fmpq(10) ** -18, -18), (fmpq(10) ** 19, 0), (fmpq(1001, 10), 2),
     (fmpq(1006, 10), 0), (fmpq(1), 0), (fmpq(0), 0), (fmpq(-100), 0)],
)  # fmt: skip
def test_powers_of_ten_are_seen_within_half_a_percent_up_to_eighteen(value, power):
    assert power_of_ten_off(value, fmpq(1)) == power


def test_one_is_a_power_of_ten_of_others_and_zero_of_none():
    assert power_of_ten_off(fmpq(1), fmpq(100)) == -2
    assert power_of_ten_off(fmpq(5), fmpq(0)) == 0


def test_half_a_percent_is_close_and_not_more():
    assert agrees_within_half_percent(fmpq(201), fmpq(200))
    assert agrees_within_half_percent(fmpq(199), fmpq(200))
    assert not agrees_within_half_percent(fmpq(20101, 100), fmpq(200))


def test_one_radian_is_57_degrees_and_nothing_is_no_angle():
    """180/π = 57.2958."""
    assert is_in_radians(fmpq(1), fmpq("573/10"))
    assert not is_in_radians(fmpq(0), fmpq(0))


def cells(*said):
    return [Verdict("wrong" if credit < 1 else "correct", Fraction(credit), note=note, fields=fields)
            for credit, note, fields in said]  # fmt: skip


TWICE, THRICE = {"factor": "2"}, {"factor": "3"}


@together(
    ("said", "shared"),
    [
        ([(0, "factor", TWICE), (0, "factor", TWICE)], ("factor", TWICE)),
        ([(0, "factor", TWICE), (0, "factor", THRICE)], ("", {})),
        ([(0, "x", {"power": 1, "asked": "m"}), (0, "x", {"power": 2, "asked": "m"})],
         ("x", {"asked": "m"})),
        ([(0, "factor", TWICE), (0, "factor", {})], ("", {})),
        ([(HALF, "factor", TWICE), (0, "factor", TWICE)], ("factor", TWICE)),
        ([(0, "factor", TWICE), (0, "sign", {})], ("", {})),
        ([(0, "factor", TWICE), (1, "", {})], ("", {})),
        ([(1, "factor", TWICE), (0, "factor", TWICE)], ("", {})),
        ([(0, "", {}), (0, "", {})], ("", {})),
    ],
)  # fmt: skip
def test_what_all_cells_share_is_said_once(said, shared):
    """Fields that differ are left out: no cell's factor stands for the others."""
    assert find_common_slip(cells(*said)) == shared


CAMERA = Chain(
    {"f": "mm", "X": "m", "Z": "m", "pitch": "um"},
    (ChainStep("h", parse_formula("f*X/Z"), "mm"), ChainStep("n", parse_formula("h/pitch"), "px")),
)
GIVEN = {"f": fmpq(1, 20), "X": fmpq(29), "Z": fmpq(600), "pitch": fmpq(7, 10**6)}


@pytest.mark.parametrize(
    ("typed", "note"),
    [("342.9", "rounded-too-early"), ("342.8", ""), ("345.2", None)],
)
def test_a_step_rounded_in_its_own_unit_is_seen_to_half_the_last_place(typed, note):
    """h = 29/12 mm is 2.4 mm in two figures; 2.4 mm / 7 µm = 342.857; the key is 345.238."""
    spec = {"kind": "number", "value": "7250/21", "decimals": 1, "of": ["n"]}
    found = grade_answer(spec, typed, context=QuestionContext(CAMERA, GIVEN))
    assert (found.note, found.read_as) == (note or "", typed)
    assert found.credit == {"rounded-too-early": HALF, "": 0, None: 1}[note]


@together(
    ("rule", "value", "typed"),
    [
        ({"decimals": 1, "within": "1/4"}, "5/4", "1.3"),
        ({"sigfigs": 2, "within": "1/4"}, "5/4", "1.3"),
        ({"decimals": 2}, "1/4", "0.3"),
        ({"abs": "1/1000"}, "2", "2.005"),
        ({"exact": True}, "sqrt(2)", "1.5"),
        ({"decimals": 3}, "123456", "123.456"),
    ],
)  # fmt: skip
def test_digits_excuse_nothing_where_they_are_not_the_matter(rule, value, typed):
    found = grade_answer({"kind": "number", "value": value, **rule}, typed)
    assert (found.verdict, found.credit) == ("wrong", 0)
    assert found.note not in {"decimals-asked", "figures-asked", "whole-number"}


def test_a_form_that_was_not_asked_is_echoed():
    lowest = grade_answer(
        {"kind": "number", "value": "1/2", "exact": True, "form": "lowest"}, "2/4"
    )
    assert (lowest.note, lowest.credit, lowest.read_as) == ("form-lowest", HALF, "2/4")
    fraction = grade_answer(
        {"kind": "number", "value": "1/2", "exact": True, "form": "fraction"}, "0.5"
    )
    assert (fraction.note, fraction.credit, fraction.read_as) == ("form-fraction", HALF, "0.5")
    decimal = grade_answer(
        {"kind": "number", "value": "1/2", "exact": True, "form": "decimal"}, "1/2"
    )
    assert (decimal.note, decimal.credit, decimal.read_as) == ("form-decimal", HALF, "1/2")


def test_what_a_slip_fills_into_its_sentence():
    assert dict(grade_answer({"kind": "number", "value": "3"}, "3000").fields) == {"power": 3}
    assert dict(grade_answer({"kind": "number", "value": "3"}, "12").fields) == {"factor": "4"}


def test_what_is_carried_forward_is_echoed_with_its_unit():
    """An own h of 3 mm instead of 29/12 mm fills 6 mm of film twice as high."""
    film = Chain(
        {"a": "mm"},
        (ChainStep("h", parse_formula("a"), "mm"), ChainStep("w", parse_formula("2*h"), "mm")),
    )
    context = QuestionContext(film, {"a": fmpq(29, 12000)}, {"h": fmpq(3, 1000)})
    spec = {"kind": "quantity", "value": "29/6", "unit": "mm", "of": ["w"]}
    found = grade_answer(spec, "6 mm", context=context)
    assert (found.note, found.credit, found.read_as) == ("carried-forward", 1, "6 mm")


def test_a_slip_in_the_chain_is_echoed_with_its_unit():
    """1/50 - 1/200 = 3/200 gives 200/3 mm; with a plus, 1/50 + 1/200 = 1/40 gives 40 mm."""
    steps = (
        ChainStep("r", parse_formula("1/f - 1/z"), "1/mm"),
        ChainStep("b", parse_formula("1/r"), "mm"),
    )
    lens = Chain({"f": "mm", "z": "mm"}, steps)
    context = QuestionContext(lens, {"f": fmpq(1, 20), "z": fmpq(1, 5)})
    spec = {"kind": "quantity", "value": "200/3", "unit": "mm", "rel": "0.005", "of": ["b"]}
    found = grade_answer(spec, "40 mm", context=context)
    assert (found.note, found.read_as) == ("operator", "40 mm")
