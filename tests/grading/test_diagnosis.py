"""Which mistake gives a number: numbers worked out by hand for the notes' own examples."""

from __future__ import annotations

import time

import pytest
from flint import fmpq
from sweep import together

from quizgen.grading.diagnosis.slip_search import mutate_formula
from quizgen.grading.feedback import load_sentences
from quizgen.grading.options import QuestionContext
from quizgen.kinds.grade import grade_answer
from quizgen.locale import list_languages
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse_formula


def chain(given, *steps):
    return Chain(
        given, tuple(ChainStep(name, parse_formula(text), unit) for name, text, unit in steps)
    )


# C14: a 30 m tower at 600 m, f = 50 mm, 5 µm pixels: 2.5 mm, 500 px
TOWER = chain(
    {"f": "mm", "X": "m", "Z": "m", "pitch": "um"},
    ("h", "f*X/Z", "mm"),
    ("n", "h/pitch", "px"),
)
TOWER_GIVEN = {"f": fmpq(1, 20), "X": fmpq(30), "Z": fmpq(600), "pitch": fmpq(5, 10**6)}
HEIGHT = {"kind": "quantity", "value": "5/2", "unit": "mm", "rel": "0.005", "of": ["h"]}
PIXELS = {"kind": "number", "value": "500", "exact": True, "of": ["n"]}

# D17a: f = 50 mm, z = 200 mm
LENS = chain({"f": "mm", "z": "mm"}, ("r", "1/f - 1/z", "1/mm"), ("z'", "1/r", "mm"))
LENS_GIVEN = {"f": fmpq(1, 20), "z": fmpq(1, 5)}
IMAGE = {"kind": "quantity", "value": "200/3", "unit": "mm", "rel": "0.005", "of": ["z'"]}

# B7: f/2 to f/16: light 64, 6 stops
STOPS = chain({"N_1": "", "N_2": ""}, ("q", "(N_2/N_1)^2", ""), ("e", "log2(q)", "stop"))
STOPS_GIVEN = {"N_1": fmpq(2), "N_2": fmpq(16)}
LIGHT = {"kind": "number", "value": "64", "exact": True, "of": ["q"]}
STOP = {"kind": "number", "value": "6", "decimals": 2, "of": ["e"]}

# X-A11: field of view 2 atan(S/(2f)), 36 mm and 50 mm: 39.6°
ANGLE = {"kind": "number", "value": "39.5977527", "decimals": 1, "of": ["a"]}


@together(
    ("spec", "typed", "model", "given", "note"),
    [
        (IMAGE, "40 mm", LENS, LENS_GIVEN, "operator"),  # 1/f + 1/z
        (IMAGE, "-66.67 mm", LENS, LENS_GIVEN, "sign"),
        (LIGHT, "8", STOPS, STOPS_GIVEN, "square-forgotten"),
        (LIGHT, "1/64", STOPS, STOPS_GIVEN, "ratio-inverted"),
        (STOP, "3", STOPS, STOPS_GIVEN, "square-forgotten"),
        (STOP, "1.81", STOPS, STOPS_GIVEN, "log-base"),  # log10(64) = 1.806
        (STOP, "4.16", STOPS, STOPS_GIVEN, "log-base"),  # ln(64) = 4.159
    ],
)
def test_one_slip_in_the_chain_is_named(spec, typed, model, given, note):
    context = QuestionContext(model, given)
    verdict = grade_answer(spec, typed, context=context)
    assert verdict.note == note, verdict
    assert verdict.credit == 0
    assert verdict.message


def test_a_number_that_several_slips_explain_is_not_explained():
    """16 is 8·2 as well as N_2 alone; 50 mm is 1/(1/f) as well as z taken a thousandfold."""
    assert grade_answer(LIGHT, "16", context=QuestionContext(STOPS, STOPS_GIVEN)).note == "factor"
    assert grade_answer(IMAGE, "50 mm", context=QuestionContext(LENS, LENS_GIVEN)).note == ""


def test_carried_forward_gets_full_method_marks():
    """3.5 mm instead of 2.5 mm; 3.5 mm / 5 µm = 700 px."""
    context = QuestionContext(TOWER, TOWER_GIVEN, {"h": fmpq(35, 10**4)})
    verdict = grade_answer(PIXELS, "700", context=context)
    assert (verdict.verdict, verdict.credit, verdict.note) == ("partial", 1, "carried-forward")
    assert grade_answer(PIXELS, "500", context=context).verdict == "correct"
    assert grade_answer(PIXELS, "650", context=context).credit == 0


@pytest.mark.parametrize(
    ("earlier", "typed"),
    [
        ({}, "700"),  # nothing typed earlier
        ({"h": fmpq(0)}, "0"),  # zero
        ({"h": fmpq(25, 10**4)}, "700"),  # the earlier value is right
        ({"n": fmpq(700)}, "700"),  # not upstream
    ],
)
def test_nothing_is_carried_where_it_would_be_a_gift(earlier, typed):
    verdict = grade_answer(PIXELS, typed, context=QuestionContext(TOWER, TOWER_GIVEN, earlier))
    assert verdict.note != "carried-forward"
    assert verdict.credit == 0


def test_an_own_value_that_makes_the_question_trivial_is_not_carried():
    """With q = 1 the stops are 0."""
    context = QuestionContext(STOPS, STOPS_GIVEN, {"q": fmpq(1)})
    assert grade_answer(STOP, "0", context=context).credit == 0


def test_an_own_value_that_a_step_leaves_as_it_is_is_carried():
    """A clamp at 0 leaves 7 as it is, and it is not what makes 7 wrong."""
    model = chain({"x": ""}, ("a", "2*x", ""), ("b", "max(a, 0)", ""))
    spec = {"kind": "number", "value": "6", "exact": True, "of": ["b"]}
    same = QuestionContext(model, {"x": fmpq(3)}, {"a": fmpq(7)})
    assert grade_answer(spec, "7", context=same).note == "carried-forward"


def test_an_own_value_equal_to_the_later_key_is_not_carried():
    model = chain({"x": ""}, ("a", "x - 1", ""), ("b", "abs(a)", ""))
    spec = {"kind": "number", "value": "2", "exact": True, "of": ["b"]}
    context = QuestionContext(model, {"x": fmpq(3)}, {"a": fmpq(-2)})
    assert grade_answer(spec, "2", context=context).note == ""


def test_rounding_too_early_is_named_and_costs_half():
    """D20b: 0.2^(1/2.2) = 0.481 and 0.8^(1/2.2) = 0.904 average to 0.6925, not 0.69235."""
    model = chain(
        {"a": "", "b": ""},
        ("p", "a^(1/2.2)", ""),
        ("q", "b^(1/2.2)", ""),
        ("m", "(p + q)/2", ""),
    )
    spec = {"kind": "number", "value": "0.692349", "decimals": 5, "of": ["m"]}
    context = QuestionContext(model, {"a": fmpq(1, 5), "b": fmpq(4, 5)})
    verdict = grade_answer(spec, "0.6925", context=context)
    assert (verdict.note, verdict.credit) == ("rounded-too-early", 0.5)


def test_traps_come_before_mutations():
    spec = {**LIGHT, "traps": {"light-like-diameter": "8"}}
    verdict = grade_answer(spec, "8", context=QuestionContext(STOPS, STOPS_GIVEN))
    assert verdict.note == "trap:light-like-diameter"


def test_the_templates_own_sentence_is_shown():
    spec = {
        **LIGHT,
        "traps": {"t": "8"},
        "notes": {"en": {"t": "Square it."}, "bn": {"t": "বর্গ করুন।"}},
    }
    assert grade_answer(spec, "8").message == "Square it."
    assert grade_answer(spec, "8", lang="bn").message == "বর্গ করুন।"


@pytest.mark.parametrize(
    ("typed", "note"),
    [("39.6", ""), ("79.2", "factor"), ("0.69", ""), ("1.42", "")],
)
def test_field_of_view(typed, note):
    verdict = grade_answer(ANGLE, typed)
    assert verdict.note == note


def test_every_slip_has_a_sentence_in_every_language():
    trees = [parse_formula(t) for t in (
        "a+b", "a-b", "a*b", "a/b", "a^2", "a^3", "sqrt(a)", "sin(a)", "atan(a)", "atan2(a,b)", "ln(a)",
        "-a", "exp(a)", "abs(a)", "min(a,b)", "floor(a)",
    )]  # fmt: skip
    notes = {note for tree in trees for note, _, _ in mutate_formula(tree, {"a": ["b"]})}
    for lang in list_languages():
        assert notes | {"step-left-out", "unit-prefix-given"} <= load_sentences(lang).keys()


@pytest.mark.parametrize("lang", sorted({*list_languages()} - {"en"}))
def test_languages_have_the_same_sentences(lang):
    assert load_sentences("en").keys() == load_sentences(lang).keys()
    for note, text in load_sentences("en").items():
        blanks = {b.split("}")[0] for b in text.split("{")[1:]}
        assert blanks == {b.split("}")[0] for b in load_sentences(lang)[note].split("{")[1:]}, note


@pytest.mark.slow
def test_full_diagnosis_of_a_wrong_answer_is_fast():
    context = QuestionContext(TOWER, TOWER_GIVEN)
    grade_answer(HEIGHT, "3.3 mm", context=context)
    start = time.process_time()
    for number in range(100):
        grade_answer(HEIGHT, f"3.{number:02d}1 mm", context=context)
    assert (time.process_time() - start) / 100 < 0.01


def test_a_term_left_out_leaves_the_others():
    def leave_out(formula):
        made = mutate_formula(parse_formula(formula), {})
        return [form for note, _, form in made if note == "term-left-out"]

    assert leave_out("a + b") == [*map(parse_formula, "ba")]
    assert leave_out("a + b + c") == [*map(parse_formula, ("b + c", "a + c", "a + b"))]
