"""A deck for the tests, built once."""

from __future__ import annotations

import pytest

from quizgen.cards import build_deck
from quizgen.cards.apkg import write_apkg


@pytest.fixture(scope="session")
def deck():
    return build_deck("both", seed=1)


@pytest.fixture(scope="session")
def packed(deck):
    return write_apkg(deck)
