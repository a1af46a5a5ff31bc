"""What is proven is the code as it stands, and the proof is one."""

from __future__ import annotations

import random
from fractions import Fraction

import flint
import gaps
import mpmath as mp
import numpy as np
import prove
import pytest
import uniform
from flint import arb

ROWS = {line.split("\t")[0]: line.split("\t")[1:] for line in prove.PROOFS.read_text().splitlines()}


@pytest.fixture(autouse=True)
def precision():
    with flint.ctx.workprec(300):
        cap, flint.ctx.cap = flint.ctx.cap, prove.ORDER
        yield
        flint.ctx.cap = cap


@pytest.mark.parametrize("name", prove.PIECES)
def test_the_code_is_what_was_proven(name):
    """After a change: ``python tests/arrays/prove.py``."""
    bound, _, rounds, digest = ROWS[name]
    assert int(rounds) == prove.PIECES[name].rounds
    assert digest == prove.PIECES[name].digest()
    assert float(bound) < 30


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
    assert prove.far_bound(arb(2) + arb(0, 0.001)) / prove.UNIT > 100


def test_a_wrong_fraction_is_seen(monkeypatch):
    (first, *rest), below = prove.gaussian._QUANTILE_NEAR
    wrong = ((first * (1 + 2**-44), *rest), below)
    monkeypatch.setattr(prove.gaussian, "_QUANTILE_NEAR", wrong)
    assert prove.tail_bound(arb(2) + arb(0, 0.001)) / prove.UNIT > 100


@pytest.mark.parametrize("k", [1, 2, 30, 59, 60, 61, 5000])
def test_no_sum_has_more_terms_than_recorded(k, monkeypatch):
    most, asked, plain = prove.PIECES["poisson.lower by sums"].rounds, [], np.maximum
    monkeypatch.setattr(np, "maximum", lambda *args: (asked.append(1), plain(*args))[1])
    for mean in ([k, k * (1 + 1e-12)] if k <= 60 else []) + [1.5 * (k + 1)]:
        asked.clear()
        prove.poisson._sum_down(np.array([float(k)]), np.array([mean]))
        assert 0 < len(asked) <= 2 * most  # there and back


def test_no_root_takes_more_rounds_than_recorded(monkeypatch):
    most = prove.PIECES["inverse_radius, k2 (log2 of slope)"].rounds
    asked = []
    plain = prove.quintic.Quintic.value_and_slope
    monkeypatch.setattr(
        prove.quintic.Quintic, "value_and_slope",
        lambda self, x: (asked.append(1), plain(self, x))[1],
    )  # fmt: skip
    source = random.Random(8)
    for _ in range(300):
        k1 = source.choice([-1, 1]) * 10 ** source.uniform(-8, 8)
        k2 = 9 * k1 * k1 / 20 * (1 + source.choice([-1, 1]) * 10 ** source.uniform(-16, 0))
        fold = prove.distortion.fold_radius(k1, k2)
        x = (fold if np.isfinite(fold) else abs(k1) ** -0.5) * (1 - 10 ** source.uniform(-12, -0.1))
        asked.clear()
        prove.distortion._inverse(
            *(np.array([v]) for v in (x * (1 + k1 * x**2 + k2 * x**4), k1, k2))
        )
        assert len(asked) <= most // 2


@pytest.mark.parametrize("a", [61, 62, 100])
@pytest.mark.parametrize("ratio", [flint.fmpq(r, 20) for r in (11, 15, 19, 21, 25, 29)])
def test_what_the_expansion_leaves_out_is_below_its_bound(a, ratio):
    """By the incomplete gamma function of Arb."""
    left_out = uniform.at_border(a, ratio)
    assert left_out < uniform.truncation() < prove.UNIT / 8


def test_a_wrong_coefficient_of_the_expansion_is_seen(monkeypatch):
    (first, *rest), *others = prove.tables.TEMME
    wrong = ((first * (1 + 2**-44), *rest), *others)
    monkeypatch.setattr(prove.tables, "TEMME", wrong)
    assert uniform.missing() / prove.UNIT > 100


@pytest.mark.parametrize("exponent", [9, 20, 40, 52, 53, 54, 55])
@pytest.mark.parametrize("deviations", [-8, -1, -0.01, 0, 0.3, 2, 30])
def test_lower_tails_of_any_count_keep_to_the_bound(exponent, deviations):
    """Next to the mean; from 2**53 on the next count is no double."""
    count = 2**exponent
    mean = float(count + 1 + deviations * count**0.5)
    exact = arb(mean).gamma_upper(arb(count) + 1, 1)
    off = abs(arb(float(prove.poisson.lower(float(count), mean))) / exact - 1)
    assert off / prove.UNIT < float(
        ROWS["poisson.lower by Temme's expansion (root of twice the excess)"][0]
    )


def gap_over_q(e, q):
    d = mp.sqrt(q)
    return (1 - ((1 + d) ** e + (1 - d) ** e) / 2) / q


@pytest.mark.parametrize("e", [0.01, 0.3, 0.9])
@pytest.mark.parametrize("q", [0.1, 0.7])
def test_the_gap_is_the_integral_that_its_bound_is_made_of(e, q):
    with mp.workdps(25):
        found = mp.quad(
            lambda root: 2 * (root - 1) ** e / (root * (root * root - q)),
            [1, 1.5, 2, 4, 100, mp.inf],
        )
        assert mp.almosteq(mp.sin(mp.pi * e) / (2 * mp.pi) * found, gap_over_q(e, q), 1e-8)


@pytest.mark.parametrize("exponent", ["1/100", "1/4", "5/11", "9/10"])
def test_the_polynomial_of_the_gap_is_within_its_bound(exponent):
    e = Fraction(exponent)
    over_q, _ = prove.gamma_gap._direct(e)
    parts = prove.gamma_gap._interpolate(over_q, 0.0, 2 * gaps.CENTRE, gaps.CENTRE, gaps.COUNT)
    with mp.workdps(60):
        for place in range(60):
            w = mp.mpf(2 * gaps.CENTRE) * (place + mp.mpf(1) / 3) / 60
            found = mp.polyval(
                [mp.mpf(c.numerator) / c.denominator for c in reversed(parts)], w - gaps.CENTRE
            )
            exact = gap_over_q(mp.mpf(e.numerator) / e.denominator, w / (1 + gaps.BEND * w))
            ends = 2 * gaps.CENTRE * place / 60, 2 * gaps.CENTRE * (place + 1) / 60
            assert abs(found / exact - 1) < gaps.interpolation(ends)


@pytest.mark.parametrize("gamma", [1.4, 9.9, 10.1, 50, 100, 1e4])
def test_gaps_of_values_that_are_nothing_beside_the_other_keep_to_their_bound(gamma):
    for small in (5e-324, 7.4e-323, 3e-310, 1e-280, 1e-200, 1e-30):
        with mp.workdps(60):
            a, b, e = mp.mpf(small), mp.mpf(0.75), 1 / mp.mpf(str(gamma))
            exact = ((a + b) / 2) ** e - (a**e + b**e) / 2
            off = abs(mp.mpf(float(prove.gamma.gap(small, 0.75, gamma))) / exact - 1)
        assert off < 10 * 2**-53
