"""What a solution shows of number systems: Python's own floats, NumPy's float32, mpmath's digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from sweep import together

from quizgen.bank.variant import draw_variant
from quizgen.question.solution import precision_table


def shown(text: str) -> float:
    mantissa, _, power = text.replace("\u202f", "").partition("·10")
    digits = power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    return float(mantissa) * 10.0 ** int(digits or 0)


@together("seed", range(12))
def test_the_far_tail_in_three_number_systems(bank, seed):
    one = draw_variant(bank.template("gaussian-far-tail-in-float64"), seed)
    k = int(one.shown["k"].p) / int(one.shown["k"].q)
    (table,) = precision_table(one, "en")
    single, double, exact = (shown(row[1][0].text) for row in table.rows)
    a = np.float32(np.float32(k) / np.float32(math.sqrt(2)))
    assert single == np.float32(1) - np.float32(math.erf(a))
    assert double == pytest.approx(1 - math.erf(k / math.sqrt(2)), rel=1e-8)
    with mpmath.workdps(60):
        assert exact == pytest.approx(float(mpmath.erfc(mpmath.mpf(k) / mpmath.sqrt(2))), rel=1e-8)


def rows(one):
    (table,) = precision_table(one, "en")
    return [shown(row[1][0].text.split("\N{NO-BREAK SPACE}")[0].rstrip("°")) for row in table.rows]


def given(one, name):
    return int(one.values[name].p) / int(one.values[name].q)


@together("seed", range(12))
def test_a_source_next_to_the_focal_plane(bank, seed):
    one = draw_variant(bank.template("source-near-focus-in-float32"), seed)
    f, d = given(one, "f"), given(one, "d")
    single, double, exact = rows(one)
    f32 = np.float32(f)
    z32 = np.float32(f32 + np.float32(d))
    by32 = np.float32(1) / (np.float32(1) / f32 - np.float32(1) / z32)
    assert single == pytest.approx(float(by32), rel=1e-8)
    assert exact == pytest.approx(f + f * f / d, rel=1e-8)
    assert double == pytest.approx(exact, rel=1e-8)
    lost = 6e-8 * f / d
    assert lost / 300 < abs(single / exact - 1) < 4 * lost


@together("seed", range(12))
def test_the_hue_next_to_gray(bank, seed):
    one = draw_variant(bank.template("hue-near-grey-in-float32"), seed)
    u, v = given(one, "u"), given(one, "v")
    single, double, exact = rows(one)
    gray = np.float32(given(one, "B"))
    red, green = (gray + np.float32(n) / np.float32(1e7) for n in (u, v))
    assert single == pytest.approx(
        float(np.float32(60) * ((green - gray) / (red - gray))), rel=1e-8
    )
    assert exact == pytest.approx(60 * v / u, rel=1e-8)
    assert double == pytest.approx(exact, rel=1e-7)
    assert abs(single - exact) < 30


def test_other_questions_show_no_such_table(bank):
    assert (
        precision_table(draw_variant(bank.template("gaussian-peak-and-tail-shares"), 0), "en") == ()
    )
