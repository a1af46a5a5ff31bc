"""Inequalities as answers, marks at a point, parts of an order, and a mistake worth a share."""

from __future__ import annotations

import pytest

from quizgen.kinds.grade import grade_answer

HALF_PLANE = {"kind": "equation", "value": "y < 2*x + 1", "symbols": ["x", "y"],
              "traps": {"above": "y > 2*x + 1", "with-line": "y <= 2*x + 1"}}  # fmt: skip


@pytest.mark.parametrize(("typed", "verdict", "note"), [
    ("y < 2x + 1", "correct", ""), ("2x + 1 > y", "correct", ""),
    ("3y - 6x < 3", "correct", ""), ("-y > -2x - 1", "correct", ""),
    ("y > 2x + 1", "wrong", "trap:above"), ("y ≤ 2x + 1", "partial", "trap:with-line"),
    ("2y - 4x <= 2", "partial", "trap:with-line"), ("y ≥ 2x + 1", "wrong", ""),
    ("y = 2x + 1", "wrong", ""), ("y < x + 1", "wrong", ""), ("y < ", "unreadable", "equation-expected"),
])  # fmt: skip
def test_an_inequality_may_be_turned_and_multiplied(typed, verdict, note):
    found = grade_answer(HALF_PLANE, typed)
    assert (found.verdict, found.note) == (verdict, note)


DOT = {"kind": "sketch", "view": [0, 10, 0, 10], "lines": {"c": "1.9,2.9 2.1,3.1"},
       "features": {"place": {"reads": "point", "of": ["c"]}},
       "traps": {"far": {"c": "4.9,4.9 5.1,5.1"}}}  # fmt: skip


@pytest.mark.parametrize(("typed", "verdict", "note"), [
    ("2,3 2.1,3.1", "correct", ""), ("1.8,2.8 2.2,3.2; 1.8,3.2 2.2,2.8", "correct", ""),
    ("5,5 5.1,5.1", "wrong", "trap:far"), ("2,3 2.1,3.1; 8,8 8.1,8.1", "wrong", "sketch"),
    ("0,0 9,9", "wrong", "sketch-elsewhere"),
])  # fmt: skip
def test_a_mark_is_right_where_it_lies(typed, verdict, note):
    found = grade_answer(DOT, typed)
    assert (found.verdict, found.note) == (verdict, note)


PROOF = {"kind": "order", "steps": ["A", "B", "C", "D"], "before": [["A", "B"], ["C", "D"]],
         "together": [["A", "B"], ["C", "D"]]}  # fmt: skip


@pytest.mark.parametrize(("typed", "verdict", "note"), [
    ("A B C D", "correct", ""), ("C D A B", "correct", ""), ("A C B D", "partial", "order-torn"),
    ("B A C D", "partial", "order-line"),
])  # fmt: skip
def test_parts_of_an_order_stay_together(typed, verdict, note):
    found = grade_answer(PROOF, typed)
    assert (found.verdict, found.note) == (verdict, note)


def test_a_known_mistake_may_earn_a_share():
    spec = {"kind": "number", "value": "5", "decimals": 0, "traps": {"near": "9", "far": "20"},
            "worth": {"near": "0.5"}}  # fmt: skip
    found = [grade_answer(spec, typed) for typed in ("9", "20", "5")]
    assert [(v.verdict, v.credit) for v in found] == [
        ("partial", 0.5),
        ("wrong", 0),
        ("correct", 1),
    ]


HEX = {"kind": "number", "value": "57", "exact": True, "base": 16, "traps": {"no-carry": "41"}}
BINARY = {"kind": "number", "value": "57", "exact": True, "base": 2}


@pytest.mark.parametrize(("spec", "typed", "verdict", "note"), [
    (HEX, "39", "correct", ""), (HEX, "c = 0x39", "correct", ""), (HEX, "(39)_16", "correct", ""),
    (HEX, "39h", "correct", ""), (HEX, "29", "wrong", "trap:no-carry"), (HEX, "57", "wrong", ""),
    (HEX, "57_10", "unreadable", "digits-expected"), (HEX, "3G", "unreadable", "digits-expected"),
    (HEX, "", "unreadable", "no-answer"), (BINARY, "111 001", "correct", ""),
    (BINARY, "0b111001", "correct", ""), (BINARY, "111001₂", "correct", ""),
    (BINARY, "57", "partial", "base-asked"), (BINARY, "58", "unreadable", "digits-expected"),
])  # fmt: skip
def test_a_number_of_another_base_is_typed_in_its_digits(spec, typed, verdict, note):
    found = grade_answer(spec, typed)
    assert (found.verdict, found.note) == (verdict, note)
