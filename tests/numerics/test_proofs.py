"""What the array functions give keeps to what is proven of them, and the proof is one."""

from __future__ import annotations

import random
from fractions import Fraction

import flint
import mpmath as mp
import numpy as np
import prove
import pytest
from flint import arb
from functions import function
from mills import mills_error
from oracle import reference
from ulp import ulps

from quizgen.numerics import distortion

ROWS = {line.split("\t")[0]: line.split("\t")[1:] for line in prove.PROOFS.read_text().splitlines()}


@pytest.fixture(autouse=True)
def precision():
    with flint.ctx.workprec(300):
        cap, flint.ctx.cap = flint.ctx.cap, prove.ORDER
        yield
        flint.ctx.cap = cap


def drawn(*ranges, count=60):
    """Rows of numbers: uniform between two bounds, or powers of ten between two exponents."""
    rng = random.Random(12)
    return [
        tuple(
            10.0 ** rng.uniform(*bounds[1:]) if bounds[0] == "10^" else rng.uniform(*bounds)
            for bounds in ranges
        )
        for _ in range(count)
    ]


INPUTS = {
    "gaussian.quantile next to 1/2": ("gaussian.inverse_upper_tail", drawn((0.075, 0.925))),
    "gaussian.quantile to exp(-25)": ("gaussian.inverse_upper_tail", drawn(("10^", -10.8, -1.2))),
    "gaussian.quantile below exp(-25)": ("gaussian.inverse_upper_tail", drawn(("10^", -307, -10.9))),
    "hsv.to_rgb": ("hsv.green", drawn((-720, 720), (-3, 3), (0, 1))),
    "gamma.srgb_decode, dim": ("gamma.srgb_decode", drawn((0, 0.04))),
    "gamma.srgb_decode, bright (log2)": ("gamma.srgb_decode", drawn(("10^", -1.3, 100))),
    "distortion.distort": (
        "distortion.distort_x", drawn((-0.6, 0.6), (-0.6, 0.6), (-0.3, 0.3), (0, 0.1)),
    ),
    "fold_radius, k2 = 0": ("distortion.fold_radius", [(-k, 0.0) for (k,) in drawn((0.01, 9))]),
    "fold_radius, both coefficients": (
        "distortion.fold_radius", drawn((-0.5, -0.1), (-0.1, 0.004)),
    ),
    "inverse_radius, k1 >= 0, k2 = 0": (
        "distortion.inverse_radius", [(d, k, 0.0) for d, k in drawn((0, 2), ("10^", -6, 3), count=20)],
    ),
    "inverse_radius, k1 < 0, k2 = 0 (log2 of slope)": (
        "distortion.inverse_radius", [(d, -k, 0.0) for d, k in drawn((0, 0.66), (0, 0.3), count=20)],
    ),
    "inverse_radius, k2 (log2 of slope)": (
        "distortion.inverse_radius", drawn((0, 0.5), (-0.3, 0.3), (-0.02, 0.02), count=20),
    ),
    "luminosity.efficiency": ("luminosity.luminous_efficiency", drawn((361, 829))),
}  # fmt: skip
"""By kernel: a function that runs nothing else on these inputs.

The others are parts of functions: powers of ``srgb_decode``.
"""


@pytest.mark.parametrize("name", INPUTS)
def test_values_keep_to_the_proven_bound(name):
    """By mpmath; a change of the code that loses more than was proven is seen here."""
    called, rows = INPUTS[name]
    off = 0.0
    for row in rows:
        truth = reference(called, row)
        with mp.workdps(60):
            off = max(off, float(abs(mp.mpf(float(function(called)(*row))) - truth) / abs(truth)))
    assert 0 < off <= float(ROWS[name][0]) * 2.0**-53


def test_every_bound_is_on_record():
    assert ROWS.keys() == prove.PIECES.keys()
    for name, (bound, boxes, rounds) in ROWS.items():
        assert float(bound) < 30
        assert (int(boxes), int(rounds)) == (prove.PIECES[name].count, prove.PIECES[name].rounds)


def test_a_channel_of_hsv_that_nearly_vanishes_keeps_all_its_digits():
    """Saturations above 1 beside a hue at which 1 - S (60 - H)/60 is as good as nothing."""
    rng, off, least = random.Random(1), 0.0, 1.0
    for _ in range(400):
        saturation = 1 + 2.0 ** rng.uniform(-52, 0)
        left = rng.choice([-1, 1]) * 2.0 ** rng.uniform(-80, -45)
        hue = float(60 * (Fraction(saturation) - 1 + Fraction(left)) / Fraction(saturation))
        truth = reference("hsv.green", (hue, saturation, 1.0))
        if 0 < hue < 60 and truth:
            least = min(least, abs(float(truth)))
            off = max(off, ulps(function("hsv.green")(hue, saturation, 1.0), truth))
    assert least < 2.0**-75
    assert off <= 1.25


@pytest.mark.parametrize("name", prove.PIECES)
def test_some_boxes_keep_to_the_bound(name):
    piece = prove.PIECES[name]
    some = list(prove.boxes(piece.low, piece.high, piece.count))[:: max(piece.count // 20, 1)]
    found = max(float((piece.bound(box) / prove.UNIT).upper()) for box in some)
    assert found <= float(ROWS[name][0]) + 0.005


def test_the_documents_print_the_record():
    assert prove.HEAD + prove.table() + "\n\n" in prove.DOCS.read_text()


def test_a_wrong_coefficient_is_seen(monkeypatch):
    first, *rest = prove.tables.MILLS
    for module in (prove.tables, prove.gaussian):
        monkeypatch.setattr(module, "MILLS", (first * (1 + 2**-44), *rest))
    assert mills_error(arb(6) + arb(0, 0.001))[1] / prove.UNIT > 100


def test_a_wrong_fraction_is_seen(monkeypatch):
    (first, *rest), below = prove.gaussian._QUANTILE_NEAR
    wrong = ((first * (1 + 2**-44), *rest), below)
    monkeypatch.setattr(prove.gaussian, "_QUANTILE_NEAR", wrong)
    assert prove.tail_bound(arb(2) + arb(0, 0.001)) / prove.UNIT > 100


def test_no_root_takes_more_rounds_than_recorded(monkeypatch):
    most = prove.PIECES["inverse_radius, k2 (log2 of slope)"].rounds
    asked = []
    plain = prove.quintic.QuinticSolver.value_and_slope
    monkeypatch.setattr(
        prove.quintic.QuinticSolver, "value_and_slope",
        lambda self, x: (asked.append(1), plain(self, x))[1],
    )  # fmt: skip
    source = random.Random(8)
    for _ in range(300):
        k1 = source.choice([-1, 1]) * 10 ** source.uniform(-8, 8)
        k2 = 9 * k1 * k1 / 20 * (1 + source.choice([-1, 1]) * 10 ** source.uniform(-16, 0))
        fold = distortion.fold_radius(k1, k2)
        x = (fold if np.isfinite(fold) else abs(k1) ** -0.5) * (1 - 10 ** source.uniform(-12, -0.1))
        asked.clear()
        distortion._invert_radius(
            *(np.array([v]) for v in (x * (1 + k1 * x**2 + k2 * x**4), k1, k2))
        )
        assert len(asked) <= most // 2
