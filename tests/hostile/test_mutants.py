"""Mutants of every kind of file: each is a located error or the right result, and none takes long."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from kinds import KINDS
from run import LARGEST, LONGEST, tried, warm
from sweep import draws

CHUNK = 125
LONG_CHUNK = 250


@pytest.fixture(scope="module", autouse=True)
def _warm():
    warm()


def failures(numbers):
    found = [tried(number) for number in numbers]
    assert {one.kind for one in found} == KINDS.keys()
    return [one for one in found if one.failure or not one.located], found


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # NumPy's, of numbers that nobody means
@pytest.mark.parametrize("first", range(0, 125, CHUNK))
def test_a_mutant_is_a_located_error_or_the_right_result(first):
    wrong, _ = failures(range(first, first + CHUNK))
    assert not wrong


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("first", range(100_000, 100_000 + draws(250, full=100_000), LONG_CHUNK))
def test_many_mutants_take_neither_long_nor_much(first):
    wrong, found = failures(range(first, first + LONG_CHUNK))
    assert not wrong
    assert not [one for one in found if one.seconds > LONGEST or one.megabytes > LARGEST]
