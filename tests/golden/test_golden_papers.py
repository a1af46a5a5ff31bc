"""Two papers and a deck keep their bytes."""

from __future__ import annotations

import pytest
from golden_papers import STORED, digests

EXPECTED = dict(line.split("\t") for line in STORED.read_text(encoding="utf-8").splitlines())


@pytest.fixture(scope="module")
def made():
    return digests()


@pytest.mark.parametrize("name", sorted(EXPECTED))
def test_the_bytes_are_those_stored(made, name):
    assert made[name] == EXPECTED[name], f"{name} changed; see golden_papers.py"


def test_every_file_is_stored(made):
    assert made.keys() == EXPECTED.keys()
