"""A deck for the tests, built once, and Anki collections to import it into."""

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


@pytest.fixture
def collection(tmp_path):
    from anki.collection import Collection

    opened = Collection(str(tmp_path / "collection.anki2"))
    yield opened
    opened.close()
