"""The line of text that Moodle makes of a response, taken apart."""

from __future__ import annotations

import pytest
from sweep import together

from quizgen.lms.manifest import ManifestQuestion, ResponseField
from quizgen.lms.moodle_summaries import parse_summary
from quizgen.maths.notation import FormulaReadError

NUMBER = ResponseField("number", "1", "mm")
WORD = ResponseField("words", "1")
ONE = ResponseField("one", "1", options={"A": ["dark; light"], "B": ["light"], "C": ["x_2 < 1"],
                                 "D": ["dark"]})  # fmt: skip
MANY = ResponseField("many", "1", options=ONE.options)
STEPS = ResponseField("order", "1", options={"A": ["open the shutter"], "B": ["a; b. c"], "C": ["wait"]},
              targets={"1": ["1"], "2": ["2"], "3": ["3"]})  # fmt: skip


def read(text, *asks, embedded=False):
    found = parse_summary(ManifestQuestion("", "", list(asks), embedded), text)
    return [one.code if isinstance(one, FormulaReadError) else one for one in found]


@together(
    ("text", "values"),
    [
        ("3.5", ["3.5 mm"]),
        ("-3,5", ["-3,5 mm"]),
        ("৩.৫", ["৩.৫ mm"]),
        ("3.5e-2", ["3.5e-2 mm"]),
        ("3x10^2", ["3x10^2 mm"]),
        ("3.5 cm", ["3.5 cm"]),
        ("three", ["three"]),
        ("-", []),
        ("", []),
    ],
)
def test_the_unit_behind_a_field_is_added_to_a_bare_number(text, values):
    assert read(text, NUMBER) == [values]


@together(
    ("text", "values"),
    [
        ("light", ["B"]),
        ("dark; light", ["D", "B"]),
        ("B. light", ["B"]),
        ("LIGHT", ["B"]),
        ("x2<1", ["C"]),
        ("sideways", "option-unknown"),
    ],
)
def test_options_by_their_text(text, values):
    assert read(text, MANY) == [values]


def test_a_hostile_line_takes_no_longer_than_its_length():
    """Signs that part options, as many as a cell can hold."""
    assert read("; " * 60_000 + "light", MANY) == ["option-unknown"]
    assert read("light;" * 20_000 + "light", MANY) == ["option-twice"]


def test_options_with_the_same_text_are_not_guessed():
    same = ResponseField("one", "1", options={"A": ["x 2"], "B": ["x_2"]})
    assert read("x2", same) == ["option-twice"]
    assert read("A. x2", same) == [["A"]]


@pytest.mark.parametrize(
    "text",
    [
        "part 1: 3; part 2: wait; part 3: B. light",
        "Teil 1: 3; Teil 2: wait; Teil 3: B. light",
        "partie 1 : 3; partie 2 : wait; partie 3 : B. light",
        "অংশ 1: 3; অংশ 2: wait; অংশ 3: B. light",
    ],
)
def test_fields_in_a_text(text):
    assert read(text, NUMBER, WORD, ONE, embedded=True) == [["3 mm"], ["wait"], ["B"]]


def test_fields_that_were_left_empty():
    assert read("part 1: ; part 2: ; part 3: ", NUMBER, WORD, ONE, embedded=True) == [[], [], []]
    assert read("-", NUMBER, WORD, embedded=True) == [[], []]


@pytest.mark.parametrize(
    "text",
    [
        "part 1: 3; part 2: a; part 2: b",
        "part 1: 3; part 2: a; part 3: b",
        "part 1: 3",
        "3; 4",
        "part 2: a; part 1: 3",
    ],
)
def test_fields_that_cannot_be_told_apart(text):
    assert read(text, NUMBER, WORD, embedded=True) == ["parts-apart", "parts-apart"]


def test_a_word_that_reads_like_a_field_spoils_only_what_it_could_be():
    assert read("part 1: part 1: 7; part 2: b", WORD, WORD, embedded=True) == [["part 1: 7"], ["b"]]


def test_steps_of_which_moodle_gives_the_first_signs():
    """``shorten_text`` leaves seven signs and three dots."""
    assert read("C. wait; A. open...; B. a; b...", STEPS) == [["C", "A", "B"]]
    assert read("C. wait; A. open...", STEPS) == ["steps-apart"]
    assert read("C. wait; C. wait; A. open...", STEPS) == ["steps-apart"]


def test_places_of_steps():
    assert read("part 1: 2; part 2: 1; part 3: 3", STEPS, embedded=True) == [["B", "A", "C"]]
    assert read("part 1: 2; part 2: 2; part 3: 3", STEPS, embedded=True) == ["place-twice"]
    assert read("part 1: 2; part 2: ; part 3: 1", STEPS, embedded=True) == [["C", "A"]]
    assert read("part 1: 7; part 2: ; part 3: 1", STEPS, embedded=True) == ["option-unknown"]
    assert read("A. open the shutter -> 3; C. wait -> 1", STEPS) == [["C", "A"]]
