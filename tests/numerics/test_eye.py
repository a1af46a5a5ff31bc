"""The curves of the eye against colour-science's tables of the same standards."""

from __future__ import annotations

import numpy as np
import pytest

from quizgen.numerics.luminosity import DAY, NIGHT, EfficiencyTable, luminous_efficiency

STANDARDS = {
    "day": (DAY, "CIE 1924 Photopic Standard Observer", 360, 830),
    "night": (NIGHT, "CIE 1951 Scotopic Standard Observer", 380, 780),
}


@pytest.fixture(scope="module")
def standards():
    """The tables; their package takes seconds to load, which no other test should wait for."""
    import colour

    return colour.SDS_LEFS


@pytest.mark.slow
@pytest.mark.parametrize(("curve", "name", "first", "last"), STANDARDS.values(), ids=STANDARDS)
def test_a_curve_is_the_standard_at_every_table_point(standards, curve, name, first, last):
    standard = standards[name]
    at = np.arange(first, last + 1, 5.0)
    np.testing.assert_allclose(
        luminous_efficiency(at, curve), [standard[nm] for nm in at], rtol=4e-15
    )
    np.testing.assert_array_equal(luminous_efficiency([0.0, first - 0.01, last + 0.01], curve), 0.0)


@pytest.mark.slow
@pytest.mark.parametrize(("curve", "name", "first", "last"), STANDARDS.values(), ids=STANDARDS)
def test_straight_lines_between_them_miss_little(standards, curve, name, first, last):
    standard = standards[name]
    every = np.array(standard.wavelengths)
    np.testing.assert_allclose(luminous_efficiency(every, curve), standard.values, atol=0.0025)
    assert luminous_efficiency(every, curve).sum() == pytest.approx(
        np.sum(standard.values), rel=1e-4
    )


def test_peaks_of_day_and_night():
    assert luminous_efficiency(555.0) == luminous_efficiency(507.0, NIGHT) == 1.0


def test_deep_red_looks_244_times_darker_than_green():
    """V(700) = 0.004102."""
    assert 1 / luminous_efficiency(700.0) == pytest.approx(243.8, abs=0.05)


def test_any_table_can_be_handed_in():
    assert luminous_efficiency([399.0, 400.0, 402.5, 420.0, 421.0], EfficiencyTable(400, 10, np.array([0, 1, 0]))).tolist() == [
        0.0, 0.0, 0.25, 0.0, 0.0,
    ]  # fmt: skip
