"""Blocks that cross the limits of the short ways, against the textbook formula in fractions."""

# ruff: noqa: N803, N806 - names of the textbook

from __future__ import annotations

from fractions import Fraction
from itertools import starmap

import mpmath as mp
import numpy as np
import oracle
import pytest
from ulp import ulps

from quizgen.arrays import (
    depth_of_field,
    distortion,
    gamma,
    gaussian,
    normalise,
    projection,
    vignetting,
)
from quizgen.arrays.domain import answered

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


@pytest.mark.parametrize(("k1", "k2"), [(-0.3, 0.0), (-0.3, 0.02)])
@pytest.mark.parametrize("shrunk", [(0.3, 0.5), (0.5, 0.7), (0.7, 0.8), (0.8, 0.86)])
def test_distortion_that_shrinks_a_picture(k1, k2, shrunk):
    """The fewer digits of 1 + k1 r**2 + k2 r**4 remain, the less may the short way be trusted."""
    rng = np.random.default_rng(26)
    change = -rng.uniform(*shrunk, 1000)
    r = np.sqrt(2 * change / (k1 - np.sqrt(k1 * k1 + 4 * k2 * change)))
    angle = rng.uniform(0, 1.5, 1000)
    x, y = r * np.cos(angle), r * np.sin(angle)
    with mp.workdps(45):
        for value, *point in zip(distortion.distort(x, y, k1, k2)[0], x, y, strict=True):
            truth = distorted(*map(mp.mpf, (*point, k1, k2)))
            assert ulps(float(value), truth) <= 2


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


def pixel_of(*args):
    f, pitch, x, z, o = (oracle.as_decimal(float(arg)) for arg in args)
    return o + f * x / (pitch * z)


def is_nearest(value, truth):
    """Whether no double is nearer; halfway between two both will do."""
    half = Fraction(np.spacing(abs(float(truth)))) / 2
    return abs(Fraction(float(value)) - truth) <= half * (1 + Fraction(1, 2**30))


def camera(n, places, rng):
    """Draws of focal length, pitch, coordinate, depth and principal point as short decimals."""
    return [
        rng.integers(20, 60, n) / 10**4,
        rng.integers(10, 90, n) / 10**7,
        np.round(rng.uniform(-2, 2, n), places),
        np.round(rng.choice((-1, 1), n) * rng.uniform(1, 6, n), places),
        rng.integers(0, 4000, n) / 2,
    ]


@pytest.mark.parametrize("places", [1, 2, 4, 8, 9, 12, 17])
@pytest.mark.parametrize("fixed", [(), (0, 1, 4), (3,), (0, 1, 2, 4), (2,)])
def test_pixels_are_rounded_correctly(places, fixed):
    """Many cameras or one, decimals short and long, points before and behind."""
    columns = camera(300, places, np.random.default_rng(places))
    columns = [column[0] if i in fixed else column for i, column in enumerate(columns)]
    rows = zip(*np.broadcast_arrays(*columns), strict=True)
    assert projection.pixel(*columns).tolist() == [float(pixel_of(*row)) for row in rows]


def test_pixels_that_vanish():
    f, pitch, x, z, _ = camera(300, 6, np.random.default_rng(3))
    o = -np.round(f * x / (pitch * z), 3)
    for spoilt in (x, np.concatenate([x[:-1], [1 / 3]])):
        rows = zip(f, pitch, spoilt, z, o, strict=True)
        values = projection.pixel(f, pitch, spoilt, z, o)
        assert all(map(is_nearest, values, starmap(pixel_of, rows)))


def test_pixels_of_a_whole_picture():
    """Arguments broadcast; blocks that are not short do not spoil the others."""
    x, z = np.linspace(-1, 1, 700)[None, :], np.arange(1, 101)[:, None] / 10
    values = projection.pixel(0.004, 5e-6, x, z, 320.0)
    assert values.shape == (100, 700)
    for i, j in np.random.default_rng(5).integers(0, (100, 700), (300, 2)):
        assert is_nearest(values[i, j], pixel_of(0.004, 5e-6, x[0, j], z[i, 0], 320.0))


@pytest.mark.parametrize("size", [(1e-9, 3e-7), (1e-200, 1e-199), (1e16, 1e22), (1e23, 1e150)])
def test_pixels_in_odd_units(size):
    f, pitch, x, z, o = camera(60, 3, np.random.default_rng(8))
    low, high = size
    x, z = x * low, z * high
    rows = zip(f, pitch, x, z, o, strict=True)
    assert all(map(is_nearest, projection.pixel(f, pitch, x, z, o), starmap(pixel_of, rows)))


@pytest.mark.parametrize("whole", [True, False])
def test_every_picture_with_its_own_range(whole):
    rng = np.random.default_rng(13)
    low, high = rng.integers(-50, 50, COUNT), rng.integers(60, 300, COUNT)
    values_in = rng.integers(-60, 300, COUNT) if whole else rng.uniform(-60, 300, COUNT)
    new_low, new_high = rng.integers(-2, 2, COUNT), rng.integers(2, 256, COUNT)
    values = normalise.normalise(values_in, low, high, new_low, new_high)
    rows = zip(values, values_in, low, high, new_low, new_high, strict=True)
    for value, *row in rows:
        v, a, b, c, d = (Fraction(float(arg)) for arg in row)
        assert float(value) == float(c + (v - a) * (d - c) / (b - a))


def test_an_empty_range_among_others():
    values = normalise.normalise(np.full(3, 2.0), np.array([1.0, 4.0, 2.0]), np.full(3, 4.0))
    assert answered(values).tolist() == [True, False, True]
    assert values.compressed().tolist() == [1 / 3, 0.0]


@pytest.mark.parametrize("gamma_value", [1.0, 1.0001, 1.3, 2.2, 3.4, 3.8, 5.0, 100.0, 1e6])
def test_gap_for_other_exponents(gamma_value):
    rng = np.random.default_rng(17)
    a = rng.uniform(0, 1, COUNT)
    d = np.concatenate([rng.uniform(0.8, 1, COUNT // 2), 10 ** rng.uniform(-9, 0, COUNT // 2)])
    b = a * (1 - d) / (1 + d)
    with mp.workdps(60):
        e = 1 / mp.mpf(repr(gamma_value))
        for value, *row in zip(gamma.gap(a, b, gamma_value), a, b, strict=True):
            x, y = (mp.mpf(float(arg)) for arg in row)
            assert ulps(float(value), ((x + y) / 2) ** e - (x**e + y**e) / 2) <= 4
