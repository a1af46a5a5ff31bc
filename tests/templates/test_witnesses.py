"""Counterexamples are tested, never compared: against a criterion derived by other means."""

from __future__ import annotations

import itertools
import random
from fractions import Fraction

import pytest
from sweep import together

from quizgen.bank.variant import draw_variant, reference_variant
from quizgen.kinds.grade import grade_answer
from quizgen.question.part_context import ask_part


def spec_of(bank, name, seed="reference", part=0):
    template = bank.template(name)
    one = reference_variant(template) if seed == "reference" else draw_variant(template, seed)
    return ask_part(one, part).spec, one


def typed(values):
    return "; ".join(str(v) for v in values)


@together("seed", ["reference", *range(12)])
def test_hsv_value_fails_additivity_exactly_without_a_common_largest_channel(bank, seed):
    spec, one = spec_of(bank, "hsv-nonlinearity-counterexample", seed)
    a = [Fraction(int(one.shown[f"a_{i}"].p), int(one.shown[f"a_{i}"].q)) for i in (1, 2, 3)]
    chosen = random.Random(5)
    for _ in range(60):
        b = [Fraction(chosen.randint(0, 10), 10) * (1 - channel) for channel in a]
        largest = [{i for i, v in enumerate(c) if v == max(c)} for c in (a, b)]
        refutes = not largest[0] & largest[1]
        verdict = grade_answer(spec, typed(b))
        assert (verdict.verdict == "correct") == refutes
        assert refutes or verdict.note == "predicate"


def test_a_multiple_of_the_colour_refutes_nothing(bank):
    spec, _ = spec_of(bank, "hsv-nonlinearity-counterexample")
    verdict = grade_answer(spec, "b = (0; 0; 0)")
    assert (verdict.verdict, verdict.note) == ("wrong", "predicate")


def test_colours_out_of_range_are_told_so(bank):
    spec, _ = spec_of(bank, "hsv-nonlinearity-counterexample")
    assert grade_answer(spec, "b = (0.5; 1; 0)").note == "constraint"


def bent(points, k):
    moved = [(x * (1 + k * (x * x + y * y)), y * (1 + k * (x * x + y * y))) for x, y in points]
    (ax, ay), (bx, by), (cx, cy) = moved
    return (bx - ax) * (cy - ay) != (cx - ax) * (by - ay)


@pytest.mark.parametrize("seed", range(5))
def test_three_points_of_a_line_are_a_witness_exactly_if_their_images_are_not_in_line(bank, seed):
    spec, one = spec_of(bank, "straight-line-counterexample", seed)
    k = Fraction(int(one.shown["k"].p), int(one.shown["k"].q))
    steps = [Fraction(i, 4) for i in (-2, 0, 3)]
    for x, slope in itertools.product((Fraction(0), Fraction(1, 2), Fraction(-1, 4)), (0, 1)):
        line = [(x + slope * t / 2, t) for t in steps]
        verdict = grade_answer(spec, typed(v for point in line for v in point))
        assert (verdict.verdict == "correct") == bent(line, k)


def test_points_that_are_not_in_line_are_told_so(bank):
    spec, _ = spec_of(bank, "straight-line-counterexample")
    assert grade_answer(spec, "A = (0; 0); B = (0.5; 0.5); C = (0.2; 1)").note == "constraint"


@together("seed", range(6))
def test_encoding_is_refuted_by_any_two_positive_intensities(bank, seed):
    spec, _ = spec_of(bank, "gamma-linearity-counterexample", seed, part=1)
    assert grade_answer(spec, "0.25; 0.25").verdict == "correct"
    assert grade_answer(spec, "a = 0.1; b = 0.6").verdict == "correct"
    assert grade_answer(spec, "0; 0.5").note in {"predicate", "undecided"}
