"""Blocks that cross the limits of the short ways, against the textbook formula in fractions."""

# ruff: noqa: N803, N806 - names of the textbook

from __future__ import annotations

from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
from ulp import ulps

from solvers.arrays import depth_of_field, distortion, gaussian, projection, vignetting
from solvers.arrays.domain import answered

RNG = np.random.default_rng(20)
COUNT = 400


def spread(low, high):
    return RNG.uniform(low, high, COUNT)


def cos4(r, f):
    return 1 / (1 + (r / f) ** 2) ** 2


def total(f, N, c, s):
    H = f * f / (N * c) + f
    return s * (H - f) / (H - s) - s * (H - f) / (H + s - 2 * f)


def distorted(x, y, k1, k2):
    r2 = x * x + y * y
    return x * (1 + k1 * r2 + k2 * r2 * r2)


CASES = [
    (vignetting.cos4, cos4, [spread(0, 40), np.full(COUNT, 50.0)]),
    (vignetting.cos4, cos4, [spread(0, 90), np.full(COUNT, 50.0)]),
    (depth_of_field.total_depth, total, [50.0, 8.0, 0.03, np.round(spread(51, 10000))]),
    (depth_of_field.total_depth, total, [50.0, 8.0, 0.03, spread(51, 10000)]),
    (lambda *a: distortion.distort(*a)[0], distorted, [spread(-1, 1), spread(0, 1), -0.2, 0.05]),
    (lambda *a: distortion.distort(*a)[0], distorted, [spread(-2, 2), spread(0, 1), -0.3, 0.1]),
    (lambda *a: projection.project(*a).y, lambda f, _x, y, z: f * y / z,
     [2.0, 1.0, spread(-1, 1), spread(-9, 9)]),
]  # fmt: skip


@pytest.mark.parametrize(("function", "textbook", "columns"), CASES)
def test_block_across_the_limits(function, textbook, columns):
    values = function(*columns)
    rows = zip(*np.broadcast_arrays(*columns), strict=True)
    with mp.workdps(45):
        for value, row in zip(values, rows, strict=True):
            truth = textbook(*[Fraction(float(arg)) for arg in row])
            assert ulps(float(value), mp.mpf(truth.numerator) / truth.denominator) <= 4


@pytest.mark.parametrize(("x", "mu"), [(spread(-2, 3), 0.5), (spread(-9, 9), 0.1)])
def test_density_across_the_limit(x, mu):
    with mp.workdps(45):
        for value, at in zip(gaussian.pdf(x, mu, 1.5), x, strict=True):
            truth = mp.npdf(mp.mpf(float(at)), mp.mpf(mu), mp.mpf(1.5))
            assert ulps(float(value), truth) <= 4


def test_one_missing_answer_leaves_the_others():
    z = np.array([2.0, 0.0, -4.0])
    projected = projection.project(2.0, 1.0, 3.0, z)
    assert answered(projected.x).tolist() == [True, False, True]
    assert projected.y.compressed().tolist() == [3.0, -1.5]
    decimal = projection.pixel(0.004, 5e-6, np.array([-1.0, 1.0, 0.1]), z, 320.0)
    assert decimal.compressed().tolist() == [-80.0, 300.0]
    assert answered(decimal).tolist() == [True, False, True]
