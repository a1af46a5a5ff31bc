"""Counts of electrons at given luck, against SciPy's law."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats
from sweep import together

from quizgen.camera.pixels.noise import (
    _COLUMNS,
    FARTHEST,
    FEW_ELECTRONS,
    _count_tables,
    _normal_table,
    poisson_quantiles,
)


@together("mean", [1e-3, 0.3, 3.0, 16.1, 16.2, 25.5, 400.0, 1e6])
def test_the_distribution_function_is_that_of_scipy(mean):
    normal = np.linspace(-4.4, 4.4, 300_001)
    counts = poisson_quantiles(np.full_like(normal, mean), normal)
    jumps = np.flatnonzero(np.diff(counts))
    assert (np.diff(counts) >= 0).all()
    ours, theirs = stats.norm.cdf(normal[jumps]), stats.poisson.cdf(counts[jumps], mean)
    assert np.abs(ours - theirs).max() < 4e-5


@pytest.mark.parametrize(("kind", "wrong"), [(np.float64, 1e-6), (np.float32, 1e-5)])
def test_few_electrons_are_counted_one_by_one(kind, wrong):
    source = np.random.default_rng(5)
    dark, darker = source.uniform(0, FEW_ELECTRONS, 200_000), 10 ** source.uniform(-9, 1.2, 200_000)
    means = np.concatenate([dark, darker, np.zeros(1000)]).astype(kind)
    normal = source.choice(_normal_table(np.dtype(kind)), means.size)
    exact = stats.poisson.ppf(stats.norm.cdf(normal.astype(float)), means.astype(float))
    apart = np.abs(poisson_quantiles(means, normal) - exact)
    assert (apart > 0).mean() < wrong  # luck within a rounding error of a border
    assert apart.max() <= 1


@together("mean", [0.01, 0.3, 3.0, 16.1, 16.2, 25.5, 400.0])
def test_far_out_counts_are_right_within_one_electron(mean):
    for kind in (np.float32, np.float64):
        normal = np.linspace(-FARTHEST, FARTHEST, 2001).astype(kind)
        counts = poisson_quantiles(np.full_like(normal, mean), normal)
        upper, lower = (
            stats.poisson.isf(stats.norm.sf(normal.astype(float)), mean),
            stats.poisson.ppf(stats.norm.cdf(normal.astype(float)), mean),
        )
        assert np.abs(counts - np.where(normal > 0, upper, lower)).max() <= 1


def test_over_a_cell_a_count_grows_by_one_at_most():
    """So that one comparison with the chance of the least count is enough."""
    nodes, below, _ = _count_tables(np.dtype(float))
    least = (nodes // _COLUMNS).reshape(-1, _COLUMNS)[70:-70]  # up to 4.5 deviations
    assert (least[1:, 1:] - least[:-1, :-1]).max() == 1
    assert least.max() + 1 < below.size // _COLUMNS


def test_a_brighter_pixel_never_counts_less():
    means = np.geomspace(1e-3, 1e5, 20_001)
    for normal in np.linspace(-4, 4, 17):
        counts = poisson_quantiles(means, np.full_like(means, normal))
        assert (np.diff(counts) >= 0).mean() > 0.9999
        assert np.diff(counts).min() >= -1
