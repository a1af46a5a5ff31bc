"""Numbers of a test against published data and other programs."""

from __future__ import annotations

import numpy as np
import pytest

from quizgen.classes import statistics

# Data and values of pingouin 0.5 (Vallat 2018, JOSS 3(31), 1026): read_dataset("cronbach_alpha"),
# read_dataset("cronbach_wide_missing"), cronbach_alpha(...), corr(item, sum of the others).
LIKERT = np.array(
    [
        [3, 2, 4, 1, 4, 5, 1, 4, 3, 2], [5, 4, 6, 3, 5, 1, 2, 5, 5, 5], [7, 3, 5, 5, 6, 4, 3, 3, 6, 5],
        [2, 4, 3, 3, 2, 2, 2, 6, 6, 3], [6, 5, 6, 5, 4, 4, 4, 6, 7, 5], [1, 2, 3, 4, 2, 5, 2, 3, 5, 2],
        [4, 3, 5, 3, 5, 2, 1, 2, 4, 3], [2, 4, 4, 3, 7, 2, 2, 4, 6, 5], [6, 5, 5, 5, 1, 6, 5, 2, 3, 2],
        [5, 4, 6, 4, 3, 5, 3, 1, 7, 2], [4, 3, 5, 2, 5, 3, 2, 3, 4, 1], [4, 2, 3, 2, 5, 3, 4, 2, 3, 4],
        [5, 5, 6, 2, 3, 3, 2, 4, 4, 5], [6, 5, 5, 4, 2, 2, 1, 4, 6, 5], [4, 3, 5, 5, 3, 1, 3, 2, 3, 4],
    ],
    float,
)  # fmt: skip
_ = np.nan
BINARY = np.array(
    [
        [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1], [1, 1, 1, 1, 1, 1, 1, 1, 0, 1, 0], [_, 0, 1, 1, _, 1, 1, 1, 1, 0, 0],
        [1, 1, 1, 0, 1, 1, 0, 1, 1, 0, 0], [1, 1, 1, 1, 1, 0, 0, 0, 1, 0, 0], [0, 1, _, 0, 1, 1, 1, 1, 0, 0, 0],
        [1, 1, 1, 1, 0, 0, 1, 0, 0, 0, 0], [1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0], [0, 1, 0, 1, 1, 0, 0, 0, 0, 1, 0],
        [1, 0, 0, 1, 0, 1, 0, 0, _, 0, 0], [1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0], [1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0],
    ],
    float,
)  # fmt: skip


def test_alpha_and_its_interval_are_those_of_pingouin():
    found = statistics.cronbach_alpha(LIKERT)
    assert found == pytest.approx(0.5917188485995825, abs=1e-12)
    assert statistics.feldt_interval(found, 15, 10) == pytest.approx((0.195, 0.840), abs=5e-4)
    assert statistics.feldt_interval(found, 15, 10, 0.9) == pytest.approx((0.277, 0.812), abs=5e-4)


def test_alpha_of_a_table_with_holes_is_that_of_pingouin():
    assert statistics.cronbach_alpha(BINARY) == pytest.approx(0.732660835214447, abs=1e-12)
    whole = BINARY[~np.isnan(BINARY).any(axis=1)]
    assert statistics.cronbach_alpha(whole) == pytest.approx(0.8016949152542373, abs=1e-12)
    found = statistics.feldt_interval(0.8016949152542373, 9, 11)
    assert found == pytest.approx((0.533, 0.947), abs=5e-4)


def test_discrimination_is_the_correlation_with_the_sum_of_the_others():
    expected = [0.57476679, 0.56780284, 0.52139108, 0.41760582, -0.10758308,
                -0.15723652, 0.26100774, 0.09217320, 0.44337275, 0.43368836]  # fmt: skip
    found = [statistics.item_rest_correlation(LIKERT, column) for column in range(10)]
    assert found == pytest.approx(expected, abs=1e-7)


def test_kruskal_and_wallis_on_mucociliary_efficiency():
    """Hollander and Wolfe (1973), page 116; R's kruskal.test prints 0.77143, df = 2, p = 0.68."""
    groups = [[2.9, 3.0, 2.5, 2.6, 3.2], [3.8, 2.7, 4.0, 2.4], [2.8, 3.4, 3.7, 2.2, 2.0]]
    found = statistics.kruskal_wallis([np.array(group) for group in groups])
    assert found == pytest.approx(0.6799647735788936, abs=1e-12)
    assert statistics.kruskal_wallis([np.ones(4), np.ones(5)]) is None


def test_spearman_on_iq_and_hours_of_television():
    """Wikipedia, Spearman's rank correlation coefficient, Example; p-value of SciPy."""
    iq = np.array([106, 100, 86, 101, 99, 103, 97, 113, 112, 110], float)
    hours = np.array([7, 27, 2, 50, 28, 29, 20, 12, 6, 17], float)
    found = statistics.spearman(iq, hours)
    assert found == pytest.approx((-0.1757575757, 0.6271883447764846), abs=1e-9)


def test_quantiles_are_those_of_printed_tables():
    """Tables of F (5 % points) and chi-square, as in any textbook."""
    assert statistics.f_distribution_quantile(0.95, 3, 10) == pytest.approx(3.71, abs=0.005)
    assert statistics.f_distribution_quantile(0.95, 10, 20) == pytest.approx(2.35, abs=0.005)
    assert statistics.chi_square_tail(5.991, 2) == pytest.approx(0.05, abs=5e-5)


def test_several_tests_are_corrected_after_holm():
    """R: p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm")."""
    assert statistics.holm_correction([0.01, 0.04, 0.03, 0.005]) == pytest.approx(
        [0.03, 0.06, 0.06, 0.02]
    )


def test_what_cannot_be_said_is_not_said():
    assert statistics.cronbach_alpha(np.ones((5, 3))) is None
    assert statistics.cronbach_alpha(np.ones((1, 3))) is None
    assert statistics.item_rest_correlation(np.ones((5, 3)), 0) is None
