"""Digits along an input: they vanish where mathematics says, and are written apart."""

from __future__ import annotations

import math

import numpy as np
import pytest

from quizgen.tradeoff.families import BY_NAME
from quizgen.tradeoff.slider import input_text, pieces
from quizgen.tradeoff.sweeps import PATHS, sweep


def test_every_family_has_a_path_of_finite_inputs():
    assert set(PATHS) == set(BY_NAME)
    for name, path in PATHS.items():
        columns = path.columns(path.places(5))
        assert len(columns) == len(BY_NAME[name].names)
        assert all(np.isfinite(column).all() for column in columns)


@pytest.mark.parametrize("name", sorted(BY_NAME.keys() - {"pixel"}))
def test_the_stable_form_keeps_its_digits_along_every_path(name):
    for place in sweep(BY_NAME[name], 4).places:
        assert place.digits[-1] >= 15, place


def test_the_tail_loses_its_digits_between_four_and_nine_sigma():
    found = sweep(BY_NAME["gaussian-tail"], 23)
    for place in found.places:
        assert place.right == pytest.approx(math.erfc(place.at / math.sqrt(2)), rel=1e-13)
    assert found.lost_from("float32", found.graded) == 5  # 5.7e-7, next to the 6e-8 of float32
    assert found.lost_from("float64", found.graded) == 8  # 1.2e-15, next to 1.1e-16
    assert found.lost_from("stable", found.level) is None


@pytest.mark.parametrize(
    ("value", "right", "written"),
    [
        (0.5, 17, ("5.0000000000000000", "", "·10⁻¹")),
        (-1.25, 3, ("-1.25", "00000000000000", "")),
        (3.0, 1, ("3", ".0000000000000000", "")),
        (6e-16, 0, ("", "5.9999999999999999", "·10⁻¹⁶")),
        (0.0, 0, ("", "0", "")),
        (math.nan, 0, ("", "fails", "")),
    ],
)
def test_right_digits_stand_apart_from_wrong_ones(value, right, written):
    assert pieces(value, right, "fails") == written


def test_inputs_are_short():
    assert [input_text(x) for x in (4.25, 0.003, 3.2e-7, 1e18)] == [
        "4.25", "0.003", "3.2·10⁻⁷", "1.0·10¹⁸",
    ]  # fmt: skip
