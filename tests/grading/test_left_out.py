"""What a rule leaves out of an answer must not deny it, take it back or leave it open."""

from __future__ import annotations

import pytest

from quizgen.kinds.grade import grade_answer

NUMBER = {"kind": "number", "value": "4", "exact": True}
QUANTITY = {"kind": "quantity", "value": "1300", "unit": "ml", "rel": "0.01"}
SHARE = {"kind": "number", "value": "0.4", "abs": "0.001"}
CHOICE = {"kind": "choice", "options": ["Brandenburg", "Saxony", "Bavaria"], "correct": [1]}
VALUES = {"kind": "choice", "options": ["2.5 s", "3.5 s", "4.5 s"], "correct": [2]}
YES_OR_NO = {"kind": "choice", "options": ["yes", "no"], "correct": [2]}
SEVERAL = {"kind": "multi", "options": ["a", "b", "c", "d", "e"], "correct": [1, 2, 5]}
TRUE = {"kind": "tf", "correct": [1]}
WORD = {"kind": "gap", "accept": [["black"]], "among": ["white", "red"]}
LINE = {"kind": "derivation", "symbols": {"Z": "positive"}, "let": {"Z": "12"}, "unit": "m",
        "lines": {"value": {"forms": ["Z = 12"]}}}  # fmt: skip
CASES = [
    (NUMBER, "4", ["3 -> not 4", "3 -> maybe 4", "3 -> less than 4", "3 -> naki 4", "3 -> na 4", "3 -> kein 4", "4, so no",
                   "4, halved", "4 (wrong)", "4 (no)", "4 (nein)", "4 (bhul)", "h = 5, 3*2 = 4", "~~4~~"]),
    (QUANTITY, "1300 ml", ["1300 ml is wrong", "1300 ml bhul", "1300 ml ist falsch"]),
    (SHARE, "0.4", ["0.4 = 0.3", "0.5 = 0.4"]),
    (TRUE, "true, it holds", ["yes / no", "yes naki no", "yes ba no", "yes (or no)", "yes, actually no", "maybe yes, maybe no",
                              "true (not)", "true hobe na", "true, not really", "no, no, yes", "false, false, true"]),
    (YES_OR_NO, "no, too small", ["no, yes", "no (yes)", "A no", "yes, B"]),
    (CHOICE, "A because it is in the east", ["wrong (A)", "the first, the second", "a (maybe b)", "A because B is right", "no A",
                                             "A, not sure", "Brandenburg bhul", "anything but Brandenburg", "all but Brandenburg"]),
    (VALUES, "3.5 s", ["3.5 s or 2.5 s", "2.5 s বা 3.5 s"]),
    (SEVERAL, "right are: A, B, E", ["the wrong ones are: A, B, E", "all but: A, B, E", "unsure between: A B E", "bhul gulo: A B E"]),
    (WORD, "black, since it absorbs", ["black, actually white", "black, it could be red", "red is black", "red: black"]),
    (LINE, "Z = 1200 cm", ["not Z = 12", "Z = 12 is wrong", "Z = 12 kg", "Z = 11 or 12"]),
]  # fmt: skip


@pytest.mark.parametrize(("spec", "right", "unclear"), CASES)
def test_what_is_taken_back_or_left_open_earns_nothing(spec, right, unclear):
    assert grade_answer(spec, right).verdict == "correct"
    assert {typed for typed in unclear if grade_answer(spec, typed).credit} == set()


@pytest.mark.parametrize(("spec", "typed", "verdict"), [
    (NUMBER, "5, no: 4", "correct"), (NUMBER, "16 -> 8 -> 4", "correct"), (NUMBER, "4, so longer", "correct"),
    (CHOICE, "B... no, A", "correct"), (CHOICE, "the first", "correct"), (WORD, "red, no, black", "correct"),
    (WORD, "rot, nein, schwarz", "correct"), (TRUE, "false... no, true", "correct"),
    (SEVERAL, "A, B, E - only C and D are wrong", "correct"), (LINE, "Z = 11, no, Z = 12", "correct"),
])  # fmt: skip
def test_what_is_put_in_its_place_counts(spec, typed, verdict):
    assert grade_answer(spec, typed).verdict == verdict
