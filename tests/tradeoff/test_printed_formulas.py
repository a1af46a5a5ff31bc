"""Fourteen formulas: right values, digits that go one by one, rearrangements that keep them."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import mpmath as mp
import numpy as np
import printed_by_hand
import pytest
from sweep import together

from quizgen.core.errors import MathError
from quizgen.tradeoff import lines
from quizgen.tradeoff.formulas import BY_NAME, FORMULAS
from quizgen.tradeoff.sweeps import EXAMS, SEED, sweep_formula
from quizgen.tradeoff.truth import correct_digits, truths

ITERATED, SAFE = "inverse-distortion", "hue"
SUBTRACTING = [name for name in BY_NAME if name not in {ITERATED, SAFE}]


def rows_of(columns):
    return list(zip(*(np.asarray(column, float).tolist() for column in columns), strict=True))


@pytest.fixture(scope="module")
def sweeps():
    return {formula.name: sweep_formula(formula) for formula in FORMULAS}


def exam_of(name, count=EXAMS):
    return rows_of(BY_NAME[name].exam(np.random.default_rng(SEED), count))


@together("name", BY_NAME)
def test_right_values_are_those_of_mpmath(name):
    formula = BY_NAME[name]
    path = [np.asarray(column, float) for column in formula.path(formula.places(9))]
    exam = formula.exam(np.random.default_rng(1), 9)
    for columns in (path, exam):
        for row, right in zip(rows_of(columns), truths(formula, columns), strict=True):
            assert right == pytest.approx(float(printed_by_hand.truth(name, row)), rel=2e-16), row


@together("name", BY_NAME)
def test_the_path_leads_as_near_as_it_says(name):
    formula = BY_NAME[name]
    wanted = formula.places(7)
    near = 0.7 if name in {"gamma-gap", "poisson"} else 0.01  # whole counts, a series cut short
    found = formula.left(*(np.asarray(column, float) for column in formula.path(wanted)))
    easy = wanted > 1e-11  # nearer, the rounding of the inputs moves it
    assert found[easy] == pytest.approx(wanted[easy], rel=near)


@together("name", SUBTRACTING)
def test_ten_times_nearer_costs_one_digit(sweeps, name):
    found = sweeps[name]
    for left, count in zip(found.left, found.ways["float64"].digits, strict=True):
        assert count > 15 + math.log10(left) - 1.5
    hard = [count for left, count in zip(found.left, found.ways["float64"].digits, strict=True)
            if left < 1e-9]  # fmt: skip
    assert np.median(hard) < 7


def test_undistorting_in_five_steps_fails_long_before_the_fold(sweeps):
    found = sweeps[ITERATED]
    assert all(count < 4 for left, count in zip(found.left, found.ways["float64"].digits, strict=True)
               if left < 0.1)  # fmt: skip


def test_a_hue_is_safe_in_float64_and_not_in_float32(sweeps):
    assert min(sweeps[SAFE].ways["float64"].digits) > 15
    assert min(sweeps[SAFE].ways["float32"].digits) < 1


@together("name", [name for name, formula in BY_NAME.items() if formula.stable])
def test_rearranged_formulas_keep_fourteen_digits_all_the_way(sweeps, name):
    assert min(sweeps[name].ways["stable"].digits) >= 14
    for row in exam_of(name, 20):
        found = float(BY_NAME[name].stable(*(np.array([x]) for x in row))[0])
        assert printed_by_hand.digits_of(name, found, printed_by_hand.truth(name, row)) >= 14, row


def test_in_an_exam_thirteen_of_fourteen_printed_formulas_keep_eleven_digits(sweeps):
    """By Python's own functions and mpmath; the page's come from NumPy and Arb."""
    worst = {
        name: min(printed_by_hand.printed_digits(name, row) for row in exam_of(name))
        for name in BY_NAME
    }
    assert {name for name, count in worst.items() if count < 11} == {ITERATED}
    assert 6 <= worst[ITERATED] < 7
    for name, count in worst.items():
        assert sweeps[name].exam_digits == pytest.approx(min(count, 16), abs=1), name


def test_an_exam_stays_four_powers_of_ten_from_every_difficulty(sweeps):
    assert min(one.exam_left for one in sweeps.values()) == sweeps["blur-disc"].exam_left
    assert 5e-5 < sweeps["blur-disc"].exam_left < 2e-4


ROWS = Path(__file__).parents[1] / "numerics" / "rows"
HARD = {
    "gaussian.two_sided_tail": (lines.two_sided_tail, 13),  # at 37 sigma k^2 / 2 is rounded
    "depth_of_field.far_limit": (lines.far_limit, 14),
    "gamma.gap": (lines.gamma_gap, 14),
}
"""Plain lines, tried on the rows that the array functions of these names once had to hold."""


def ordinary(name, args, right):
    """Whether a plain line promises anything: positive intensities, no pole, no subnormal."""
    if name == "gamma.gap":
        return min(args) > 1e-30 and max(args) < 1e30
    return 1e-300 < right < 1e300 and min(args) > 0


@pytest.mark.parametrize("name", HARD)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_plain_lines_keep_their_digits_on_hard_rows(name):
    line, wanted = HARD[name]
    tried = 0
    for text in (ROWS / f"{name.split('.')[0]}.tsv").read_text().splitlines():
        row, args, right, *_ = text.split("\t")
        args, right = [float.fromhex(arg) for arg in args.split()], float(mp.mpf(right))
        if row == name and ordinary(name, args, right):
            found = float(line(*(np.array([arg]) for arg in args))[0])
            assert correct_digits(found, right) >= wanted, args
            tried += 1
    assert tried >= 12


def test_vignetting_at_extremes():
    for r, f in ((1e-100, 50.0), (1.0, 1e-100), (0.0, 50.0), (1e150, 1e150)):
        with mp.workdps(300):
            a, b = mp.mpf(r), mp.mpf(f)
            right = float(1 - (b * b / (a * a + b * b)) ** 2)
        assert correct_digits(float(lines.falloff(np.array([r]), np.array([f]))[0]), right) >= 15


def test_the_textbook_hue_is_the_known_one():
    import colorsys

    rgb = np.random.default_rng(4).integers(0, 256, (300, 3)) / 255
    rgb = rgb[np.ptp(rgb, axis=1) > 0]
    expected = [360 * colorsys.rgb_to_hsv(*one)[0] for one in rgb.tolist()]
    assert lines.hue(*rgb.T) == pytest.approx(expected)


def test_where_there_is_no_answer_the_truth_says_so():
    with pytest.raises(MathError), warnings.catch_warnings():
        truths(BY_NAME["thin-lens"], [np.array([50.0]), np.array([50.0])])


@together(
    ("value", "right", "count"),
    [(2.0, 2.0, 17), (1.001, 1.0, 3), (0.0, 3.0, 0), (5.0, 1.0, 0), (1e-300, 0.0, 0),
     (math.nan, 1.0, 0), (math.inf, 1.0, 0), (math.inf, math.inf, 17)],
)  # fmt: skip
def test_correct_decimal_digits(value, right, count):
    assert round(correct_digits(value, right), 6) == count


def test_a_double_beside_the_right_one_keeps_fifteen_digits():
    assert 15 < correct_digits(math.nextafter(1, 2), 1.0) < 16


def test_digits_of_an_angle_are_those_of_the_turn():
    assert correct_digits(359.64, 0.0, 360.0) == pytest.approx(3)  # 0.36 of 360
    assert correct_digits(360.0, 0.0, 360.0) == 17
