"""What is proven is the code as it stands, and the proof is one."""

from __future__ import annotations

import random

import flint
import numpy as np
import prove
import pytest
from flint import arb
from mills import mills_error

ROWS = {line.split("\t")[0]: line.split("\t")[1:] for line in prove.PROOFS.read_text().splitlines()}


@pytest.fixture(autouse=True)
def precision():
    with flint.ctx.workprec(300):
        cap, flint.ctx.cap = flint.ctx.cap, prove.ORDER
        yield
        flint.ctx.cap = cap


@pytest.mark.parametrize("name", prove.PIECES)
def test_the_code_is_what_was_proven(name):
    """After a change: ``python tests/numerics/prove.py``."""
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
    assert mills_error(arb(6) + arb(0, 0.001))[1] / prove.UNIT > 100


def test_a_wrong_fraction_is_seen(monkeypatch):
    (first, *rest), below = prove.gaussian._QUANTILE_NEAR
    wrong = ((first * (1 + 2**-44), *rest), below)
    monkeypatch.setattr(prove.gaussian, "_QUANTILE_NEAR", wrong)
    assert prove.tail_bound(arb(2) + arb(0, 0.001)) / prove.UNIT > 100


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
