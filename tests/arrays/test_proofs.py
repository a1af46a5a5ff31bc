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
    assert digest == prove.digest()
    assert float(bound) < 10


@pytest.mark.parametrize("name", prove.PIECES)
def test_some_boxes_keep_to_the_bound(name):
    bound, low, high, count = prove.PIECES[name]
    some = list(prove.boxes(low, high, count))[:: count // 20]
    assert (
        max(float((bound(box) / prove.UNIT).upper()) for box in some)
        <= float(ROWS[name][0]) + 0.005
    )


def test_a_wrong_coefficient_is_seen(monkeypatch):
    first, *rest = prove.tables.MILLS
    for module in (prove.tables, prove.gaussian):
        monkeypatch.setattr(module, "MILLS", (first * (1 + 2**-44), *rest))
    assert prove.far_bound(arb(2) + arb(0, 0.001)) / prove.UNIT > 100
