"""What is proven is the code as it stands, and the proof is one."""

from __future__ import annotations

import flint
import prove
import pytest
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
    bound, _, digest = ROWS[name]
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
