"""Each template of the bank teaches: answers that vary, reasons for what may be ticked, mistakes."""

from __future__ import annotations

import pytest
from sweep import draws

from quizgen.audit.teach import examine
from quizgen.bank.folder import builtin

SEEDS = [200, pytest.param(draws(500), marks=pytest.mark.slow)]


@pytest.mark.parametrize("seeds", SEEDS)
@pytest.mark.parametrize("name", list(builtin().paths))
def test_it_teaches(bank, name, seeds):
    found = examine(bank.template(name), seeds)
    assert [str(one) for one in found if one.level == "error"] == []
