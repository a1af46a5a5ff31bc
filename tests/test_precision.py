"""What a solution shows of number systems: Python's own floats, NumPy's float32, mpmath's digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from quizgen.draw import draw
from quizgen.solution import precision_table


def shown(text: str) -> float:
    mantissa, _, power = text.partition("·10")
    digits = power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    return float(mantissa) * 10.0 ** int(digits or 0)


@pytest.mark.parametrize("seed", range(12))
def test_the_far_tail_in_three_number_systems(bank, seed):
    one = draw(bank.template("XF08"), seed)
    k = int(one.shown["k"].p) / int(one.shown["k"].q)
    (table,) = precision_table(one, "en")
    single, double, exact = (shown(row[1][0].text) for row in table.rows)
    a = np.float32(np.float32(k) / np.float32(math.sqrt(2)))
    assert single == np.float32(1) - np.float32(math.erf(a))
    assert double == pytest.approx(1 - math.erf(k / math.sqrt(2)), rel=1e-8)
    with mpmath.workdps(60):
        assert exact == pytest.approx(float(mpmath.erfc(mpmath.mpf(k) / mpmath.sqrt(2))), rel=1e-8)


def test_other_questions_show_no_such_table(bank):
    assert precision_table(draw(bank.template("C13"), 0), "en") == ()
