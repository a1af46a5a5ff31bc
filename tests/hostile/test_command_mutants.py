"""Every command that takes a file says in a sentence what is wrong with a damaged one."""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import click
import pytest

sys.path.insert(0, str(Path(__file__).parent))

from command_mutants import BASES, COMMANDS, LARGEST, LONGEST, try_mutants_of_base
from sweep import draws

from quizgen.cli.classes import class_
from quizgen.cli.main import COMMANDS as ALL

FEW, MANY = 8, draws(50, full=3000)
NO_FILE = {"doctor", "schema", "tradeoff"}
"""Commands that read no file of a user."""
ONLY_BEFORE_PAPERS = {"redraw"}
"""Commands of a class that refuse one with papers, as that of the mutants has."""
SERVES = {"open"}
"""Those that do not end by themselves; `tests/hostile/test_class_room.py` is about their guests."""

pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning")  # a fork beside threads


@pytest.fixture(scope="session")
def workshop(tmp_path_factory):
    """A process of its own: commands run in forks, which Typst survives in no process that has
    made a PDF, as this one may have."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as fresh:
        yield fresh, tmp_path_factory.mktemp("workshop")


def try_mutants(workshop, base, count, first=0):
    """Mutants of the commands of one base, which takes the files as they are."""
    fresh, folder = workshop
    return fresh.submit(try_mutants_of_base, folder, base, count, first).result()


@pytest.mark.parametrize("base", BASES)
def test_a_command_says_in_a_sentence_what_is_wrong_with_a_damaged_file(workshop, base):
    assert [one for one in try_mutants(workshop, base, FEW) if one.failures] == []


@pytest.mark.slow
@pytest.mark.parametrize("base", BASES)
def test_many_damaged_files_take_neither_long_nor_much(workshop, base):
    tried = try_mutants(workshop, base, MANY, first=1000)
    assert [one for one in tried if one.failures] == []
    assert max(one.result.seconds for one in tried) <= LONGEST
    assert max(one.result.megabytes for one in tried) <= LARGEST


def test_every_command_that_takes_a_file_is_tried():
    tried = {one.arguments.split()[0] for one in COMMANDS}
    assert tried == {*ALL} - NO_FILE
    assert isinstance(class_, click.Group)
    of_a_class = {one.arguments.split()[1] for one in COMMANDS if one.base in {"class", "quiz"}}
    assert {*class_.commands} - ONLY_BEFORE_PAPERS - SERVES <= of_a_class
