"""From points to grades."""

from __future__ import annotations

from fractions import Fraction

import pytest
from sweep import together

from quizgen.classes.grade_scale import BonusRule, GradeScale, read_grade_scale
from quizgen.core.errors import ClassError

# The usual scale of German universities of 100 points: 4.0 from 50, then a step every five points.
GERMAN = {0: "5.0", 49.75: "5.0", 50: "4.0", 54.75: "4.0", 55: "3.7", 60: "3.3", 65: "3.0", 70: "2.7", 75: "2.3",
          80: "2.0", 85: "1.7", 90: "1.3", 94.75: "1.3", 95: "1.0", 100: "1.0"}  # fmt: skip


@together(("points", "grade"), GERMAN.items())
def test_the_german_scale(points, grade):
    assert GradeScale().grade(Fraction(points), Fraction(100)) == grade
    assert GradeScale().passes(grade) == (grade != "5.0")


def written(folder, text):
    (folder / "scale.toml").write_text(text, "utf-8")
    return read_grade_scale(folder)


def test_a_lower_pass_mark_moves_all_steps(tmp_path):
    scale = written(tmp_path, "passed = 40\nbest = 85\n")
    assert [scale.grade(Fraction(n), Fraction(100)) for n in (39, 40, 45, 84, 85)] == [
        "5.0",
        "4.0",
        "3.7",
        "1.3",
        "1.0",
    ]


@pytest.mark.parametrize(
    ("rounding", "grade"), [("up", "4.0"), ("nearest", "5.0"), ("down", "5.0")]
)
def test_points_are_rounded_before_they_are_graded(tmp_path, rounding, grade):
    scale = written(tmp_path, f'round_to = 1\nrounding = "{rounding}"\n')
    assert scale.grade(Fraction("49.25"), Fraction(100)) == grade
    assert scale.round_points(Fraction("49.5")) == {"up": 50, "nearest": 50, "down": 49}[rounding]


def test_another_scale(tmp_path):
    scale = written(
        tmp_path, 'grades = ["A+", "A", "B"]\nfail = "F"\n[steps]\n"A+" = 80\nA = 70.5\nB = 60\n'
    )
    assert [scale.grade(Fraction(n), Fraction(20)) for n in (16, 15, 14, 11)] == [
        "A+",
        "A",
        "B",
        "F",
    ]
    assert scale.grade(Fraction("14.1"), Fraction(20)) == "A"


@together(("bonus", "points", "counted"), [
    (6, 50, 6), (6, 49, 0), (6, 96, 4), (12, 50, 10), (0, 80, 0),
])  # fmt: skip
def test_a_bonus_counts_for_those_who_pass_and_never_beyond_all_points(bonus, points, counted):
    scale = GradeScale(bonus=BonusRule(most=10))
    assert scale.count_bonus(Fraction(bonus), Fraction(points), Fraction(100)) == counted


def test_a_bonus_may_count_for_everybody(tmp_path):
    scale = written(tmp_path, "[bonus]\nmost = 2.5\nneeds_pass = false\n")
    assert scale.grade_with_bonus(Fraction(9), Fraction("47.5"), Fraction(100)) == "4.0"
    assert scale.grade_with_bonus(Fraction(9), Fraction("47.25"), Fraction(100)) == "5.0"


@pytest.mark.parametrize("text", [
    "passed = 96", "[bonus]\nmost = -1", "[bonus]\nmore = 1", "[bonus]\nneeds_pass = 3", "grades = []", '[steps]\n"6.0" = 3', "round_to = -1", 'rounding = "sideways"', "typo = 1", 'passed = "half"',
    '[steps]\n"1.0" = 60', "passed = [", "best = 120",
])  # fmt: skip
def test_a_scale_that_makes_no_sense_is_refused_with_its_place(tmp_path, text):
    with pytest.raises(ClassError, match=r"scale\.toml"):
        written(tmp_path, text)


def test_nothing_to_reach_is_the_best_grade_of_nothing():
    assert GradeScale().grade(Fraction(0), Fraction(0)) == "1.0"
