"""What is said of a wrong answer is true, has no hole in it, and gives nothing away."""

from __future__ import annotations

import re

import pytest
from flint import fmpq

from quizgen.grading.feedback import feedback_sentence, load_sentences
from quizgen.grading.options import QuestionContext
from quizgen.kinds.grade import grade_answer
from quizgen.locale import list_languages
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse_formula


def chain(given, *steps):
    return Chain(
        given, tuple(ChainStep(name, parse_formula(text), unit) for name, text, unit in steps)
    )


# A hue of 7.5°: divided by a full turn it is 0.0208, in radians 0.1309, without the 60 0.125.
HUE = {"kind": "angle", "value": "15/2", "abs": "0.5", "traps": {"turn": "1/48"},
       "notes": {"en": {"turn": "You divided by a full turn."}}}  # fmt: skip
SPREAD = {"kind": "number", "value": "5", "abs": "1", "traps": {"turn": "1/100"}}


@pytest.mark.parametrize(
    ("typed", "note"),
    [("0.0208", "trap:turn"), ("0.02", "trap:turn"), ("0.131", "radians"), ("0.125", "")],
)
def test_a_small_mistake_is_not_matched_with_the_width_of_a_large_key(typed, note):
    assert grade_answer(HUE, typed).note == note


@pytest.mark.parametrize(
    ("typed", "note"), [("0.01", "trap:turn"), ("0.0", "trap:turn"), ("0.5", "power-of-ten"),
                        ("0.9", "")],
)  # fmt: skip
def test_a_mistake_is_still_known_when_it_is_rounded(typed, note):
    assert grade_answer(SPREAD, typed).note == note


def test_a_table_and_a_point_keep_to_the_same_width():
    table = {"kind": "table", "values": {"a": "5", "b": "7"}, "abs": "1",
             "traps": {"turn": {"a": "1/100", "b": "1/50"}}}  # fmt: skip
    point = {"kind": "point", "values": ["5", "7"], "abs": "1",
             "traps": {"turn": ["1/100", "1/50"]}}  # fmt: skip
    for spec in (table, point):
        assert grade_answer(spec, "0.01; 0.02").note == "trap:turn"
        assert grade_answer(spec, "0.9; 0.8").note != "trap:turn"


# f = 50 mm, z' = 200 mm: m = z'/z; 30 m at 600 m: 2.5 mm
TOWER = chain({"f": "mm", "X": "m", "Z": "m"}, ("h", "f*X/Z", "mm"))
TOWER_GIVEN = {"f": fmpq(1, 20), "X": fmpq(30), "Z": fmpq(600)}
HEIGHT = {"kind": "quantity", "value": "5/2", "unit": "mm", "rel": "0.005", "of": ["h"]}


def test_right_digits_with_a_wrong_prefix_are_said_so_with_the_question_around():
    context = QuestionContext(TOWER, TOWER_GIVEN)
    for around in (None, context):
        verdict = grade_answer(HEIGHT, "2.5 cm", context=around)
        assert verdict.note == "unit-prefix"
        assert "Did you mean mm?" in verdict.message


def test_a_sign_is_a_sign_with_the_question_around():
    lens = chain({"f": "mm", "z": "mm"}, ("q", "1/f - 1/z", "1/mm"))
    spec = {"kind": "number", "value": "0.015", "rel": "0.005", "of": ["q"]}
    context = QuestionContext(lens, {"f": fmpq(1, 20), "z": fmpq(1, 5)})
    assert grade_answer(spec, "-0.015", context=context).note == "sign"


@pytest.mark.parametrize(
    ("spec", "typed", "note"),
    [
        ({"kind": "number", "value": "1/50", "percent": True}, "0.5 %", ""),
        ({"kind": "quantity", "value": "1/2", "unit": "s"}, "2.0 s", ""),
        ({"kind": "quantity", "value": "1/7", "unit": "s"}, "7 s", ""),
        ({"kind": "number", "value": "1/7", "rel": "1/100"}, "7", "reciprocal"),
        ({"kind": "quantity", "value": "30", "unit": "deg"}, "0.5236", "radians"),
    ],
)
def test_a_reciprocal_is_one_of_a_ratio(spec, typed, note):
    found = grade_answer(spec, typed).note
    assert found == note if note else found != "reciprocal"


@pytest.mark.parametrize("lang", list_languages())
def test_no_sentence_has_a_hole_in_it(lang):
    """Two slips of one kind may give a number: then no step can be named."""
    for note, sentence in load_sentences(lang).items():
        if "⟨" not in sentence:
            continue
        bare, named = (
            feedback_sentence(lang, note, {}),
            feedback_sentence(lang, note, {"detail": "m", "claim": "m", "code": "m"}),
        )
        assert not {*"⟨⟩{}"} & {*bare, *named}, note
        assert "m" in re.findall(r"\w+", named)
        assert "()" not in bare
        assert "  " not in bare
        assert bare[-1] in ".।"
        assert bare[-2] not in " ,:("


def test_messages_do_not_print_the_formula_asked_for():
    model = chain({"z": "mm", "z'": "mm"}, ("m", "z'/z", ""))
    context = QuestionContext(model, {"z": fmpq(1, 5), "z'": fmpq(1, 2)})
    spec = {"kind": "number", "value": "5/2", "rel": "0.005", "of": ["m"]}
    verdict = grade_answer(spec, "0.1", context=context)
    assert verdict.note == "operator"
    assert "step for m" in verdict.message
    assert "/" not in verdict.message


def test_slips_that_all_cells_share_are_said():
    """Both cells typed with the wrong sign; both a thousandfold."""
    table = {"kind": "table", "values": {"D_1": "3", "D_2": "24"}, "units": {"D_1": "mm"},
             "rel": "0.005"}  # fmt: skip
    verdict = grade_answer(table, "-3 mm; -24")
    assert "The sign is wrong." in verdict.message
    assert "The sign is wrong." in grade_answer(table, "3; -24").message
    assert "D₂" in grade_answer(table, "3; -24").message
    both = chain(
        {"f": "mm", "x": "m", "y": "m", "z": "m"}, ("u", "f*x/z", "mm"), ("v", "f*y/z", "mm")
    )
    given = {"f": fmpq(1, 20), "x": fmpq(3), "y": fmpq(5), "z": fmpq(7)}
    point = {"kind": "point", "values": ["150/7", "250/7"], "unit": "mm", "rel": "0.005",
             "of": ["u", "v"]}  # fmt: skip
    said = grade_answer(point, "(1050, 1750)", context=QuestionContext(both, given))
    assert said.note == "operator"
    assert said.message == "The wrong arithmetic operation was used."


CODE = {"kind": "code", "output": "[1, 2, 3]"}


@pytest.mark.parametrize(
    ("output", "typed", "note", "credit"),
    [
        ("[1, 2, 3]", "1, 2, 3", "output-brackets", 0.5),
        ("(1, 2)", "[1, 2]", "output-separators", 0.5),
        ("['a', 'b']", "[‘a’, ‘b’]", "", 1),
        ('{"a": 1}', "{“a”: 1}", "", 1),
        ("['a']", "[„a“]", "", 1),
    ],
)
def test_program_output_as_people_type_it(output, typed, note, credit):
    verdict = grade_answer({"kind": "code", "output": output}, typed)
    assert (verdict.note, float(verdict.credit)) == (note, credit)


def test_conditions_are_said_in_numbers_not_in_program_text():
    spec = {"kind": "witness", "predicate": "piecewise(x^2, x > 0, 1) < y", "symbols": ["x"],
            "let": {"y": "x/2"}}  # fmt: skip
    message = grade_answer(spec, "x = 2").message
    assert "4 < 1" in message
    assert "piecewise" not in message
    both = {**spec, "predicate": "x < 0 and y < 0"}
    assert "and" not in grade_answer(both, "x = 2").message.replace("stand", "")


def test_what_was_typed_is_escaped_for_pages_only():
    spec = {"kind": "witness", "predicate": "a > 5", "symbols": {"a": [0, 1]}}
    verdict = grade_answer(spec, "a = 2")
    assert "&" not in verdict.message
    assert "0 ≤ a ≤ 1" in verdict.message
    code = grade_answer({"kind": "code", "output": "x"}, "<b>")
    assert code.read_as == "<b>"
    assert "&lt;b&gt;" in code._repr_html_()
    assert "&amp;" not in code._repr_html_()
