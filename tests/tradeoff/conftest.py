"""One measurement for all tests of the page: every formula and array, a few questions."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from quizgen.bank.bank import builtin_bank
from quizgen.tradeoff.report import measure_tradeoff

FEW = ("compare-two-gaussian-noises", "dynamic-range-of-sensor", "photon-energy-and-band")


@pytest.fixture(scope="session")
def report():
    bank = builtin_bank()
    return measure_tradeoff(SimpleNamespace(template_paths=FEW, template=bank.template))
