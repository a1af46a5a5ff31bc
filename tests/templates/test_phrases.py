"""Phrases that follow from numbers, key points, examples and one-step tolerances of templates."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest
from sweep import together

from quizgen.bank.bank import Bank
from quizgen.bank.sampler import sampler_for, solve_candidate
from quizgen.bank.variant import draw_variant, reference_variant
from quizgen.kinds.grade import grade_answer
from quizgen.maths.numbers import to_rational
from quizgen.question.compose import compose_question
from quizgen.question.interpolation import inlines_to_text
from quizgen.question.part_context import ask_part

SIZES = """
topic = "projection"
tier = "A"
[draw]
height = { pick = [2, 12], unit = "m" }
thing = { words = ["person", "tree"], by = "piecewise(0, height < 5, 1)" }
[[part]]
answer = { kind = "tf", true = "height < 5" }
"""
PAGE = """# T
Here is {{ thing }}.
## words
- person: a person
- tree: a tree of {{ height }}
"""


@pytest.fixture
def sizes(tmp_path: Path):
    folder = tmp_path / "templates" / "topic" / "sizes"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(SIZES, encoding="utf-8")
    (folder / "en.md").write_text(PAGE, encoding="utf-8")
    return Bank(tmp_path).template("sizes")


def test_a_phrase_follows_from_a_number(sizes):
    drawn = [draw_variant(sizes, seed) for seed in range(30)]
    found = {(str(one.shown["height"]), one.words["thing"]) for one in drawn}
    assert found == {("2", "person"), ("12", "tree")}


def test_a_phrase_may_contain_a_drawn_value(sizes):
    stems = {
        inlines_to_text(compose_question(sizes, seed)[0].stem[0].children) for seed in range(30)
    }
    assert stems == {"Here is a person.", "Here is a tree of 12\u00a0m."}


@pytest.mark.parametrize(
    ("template", "low", "high"),
    [
        ("image-height-and-fill-distance", "1.5", "2"),
        ("image-height-and-fill-distance", "70", "150"),
    ],
)
def test_named_objects_have_plausible_sizes(bank, template, low, high):
    fitting = {"person", "statue"} if Fraction(high) < 5 else {"tower", "mast"}
    for seed in range(300):
        one = draw_variant(bank.template(template), seed)
        if Fraction(low) <= Fraction(str(one.shown["p_y"])) <= Fraction(high):
            assert one.words["thing"] in fitting


def verdict_of(template, value):
    shown = {"I": value, "I_min": "0", "I_max": "255", "N_min": "-1", "N_max": "1"}
    return solve_candidate(
        sampler_for(template), {name: to_rational(text) for name, text in shown.items()}
    )


def test_dividing_by_256_is_told_apart_as_it_would_be_written(bank):
    """64/255 = 0.25098 is 0.251, 64/256 is 0.250; 20/255 and 20/256 both round to 0.078."""
    _, traps = verdict_of(bank.template("normalise-from-8-bit-range"), "64")
    assert "one-more" in traps[0]
    assert (
        verdict_of(bank.template("normalise-from-8-bit-range"), "20")
        == "trap 'one-more' cannot be told from 'the key'"
    )


def test_half_a_unit_is_accepted_in_one_step(bank):
    spec = ask_part(reference_variant(bank.template("normalise-from-8-bit-range")), 0).spec
    assert grade_answer(spec, "0.251").verdict == "correct"
    assert grade_answer(spec, "64/255").verdict == "correct"
    assert grade_answer(spec, "0.25").note == "trap:one-more"


def test_percent_tolerances_are_in_percent(bank):
    spec = ask_part(reference_variant(bank.template("radial-points-and-line-bow")), 3).spec
    assert grade_answer(spec, "56.25 %").verdict == "correct"
    assert grade_answer(spec, "56.7 %").verdict == "correct"
    assert grade_answer(spec, "57 %").verdict == "wrong"
    assert grade_answer(spec, "93.75 %").note == "trap:inner-for-outer"


@pytest.mark.parametrize(
    ("typed", "found"),
    [
        ("The eye is most sensitive to green, and green carries the luminance", {"eye", "detail"}),
        ("চোখ সবুজে সবচেয়ে সংবেদনশীল", {"eye"}),
    ],
)
def test_key_points_are_found_in_both_languages(bank, typed, found):
    verdict = grade_answer(
        ask_part(draw_variant(bank.template("why-bayer-green-and-demosaicing"), 0), 0).spec, typed
    )
    assert verdict.note == "self-mark"
    assert set(verdict.fields["found"]) == found


def test_the_solution_of_a_sentence_shows_its_criteria(bank):
    _, key = compose_question(bank.template("why-bayer-green-and-demosaicing"), 0, "bn")
    scheme = key.solution.parts[0].scheme
    assert [str(row.points) for row in scheme] == ["1", "1"]
    assert inlines_to_text(scheme[0].idea).startswith("চোখ")


@pytest.mark.parametrize(
    ("typed", "verdict"),
    [
        ("q_x = 12; q_y = 18; q_z = 6", "correct"),
        ("2; 3; 1", "correct"),
        ("6; 9; 3", "wrong"),
        ("-6; -9; -3", "wrong"),
        ("12; 18; 3", "wrong"),
    ],
)
def test_any_other_point_of_the_ray_in_front_of_the_camera_counts(bank, typed, verdict):
    spec = ask_part(reference_variant(bank.template("points-on-one-ray")), 1).spec
    assert grade_answer(spec, typed).verdict == verdict


@together("seed", range(12))
def test_the_numbers_asked_for_are_those_of_the_picture(bank, seed):
    """The figure's own table of permutations decides where each edit stands."""
    one = draw_variant(bank.template("hsv-edit-from-pictures"), seed)
    order = bank.figure("hsv_edits").order_edits(float(int(one.shown["order"].p)))
    expected = [["1234"[order.index(edit)]] for edit in ("V", "S", "H")]
    assert [gap[:1] for gap in ask_part(one, 0).spec.accept] == expected
