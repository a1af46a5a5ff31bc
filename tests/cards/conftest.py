"""A deck for the tests, built once."""

from __future__ import annotations

import pytest

from quizgen.cards import build
from quizgen.cards.apkg import package


@pytest.fixture(scope="session")
def deck():
    return build("both", seed=1)


@pytest.fixture(scope="session")
def packed(deck):
    return package(deck)
