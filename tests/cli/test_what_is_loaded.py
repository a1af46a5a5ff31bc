"""Which packages a command loads, from its start to its end: what it loads, everybody waits for."""

from __future__ import annotations

import subprocess
import sys

import pytest

from quizgen.bank.bank import builtin_bank

pytestmark = pytest.mark.slow  # each starts processes
WALK = """
import sys
from quizgen.cli.main import main
for command in sys.argv[1:]:
    try:
        main(command.split())
    except SystemExit as end:
        assert not end.code, command
    print(*sys.modules, file=sys.stderr)
"""
DRAWING = {"numpy", "matplotlib", "PIL"}
"""What only a figure needs."""


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder; solvers are compiled and prose is read, once and for all."""
    list(builtin_bank())
    return tmp_path_factory.mktemp("loaded")


def loaded(place, *commands, typed=""):
    """What is loaded after each of some commands, one after the other in one process."""
    done = subprocess.run([sys.executable, "-c", WALK, *commands], cwd=place, check=True,
                          capture_output=True, text=True, input=typed)  # fmt: skip
    return [set(line.split()) for line in done.stderr.splitlines() if line.startswith("sys ")]


def test_no_command_from_making_a_paper_to_marking_it_loads_sympy(place):
    (made,) = loaded(place, "exam --blueprint trial --seed 3 --out paper")
    assert not {"sympy", "markdown_it", "matplotlib.pyplot"} & made
    assert "matplotlib" in made  # it draws the figures
    assert not {"quizgen.question.levels.guided", "quizgen.question.levels.transfer"} & made
    checked, practised, listed = loaded(
        place,
        "check paper/key.json paper/answers.toml",
        "practice --topic code --seed 3 --database sqlite:///learnt.sqlite3",
        "templates",
        typed="5\n",
    )
    assert not ({"sympy", "typst", "markdown_it"} | DRAWING) & checked
    assert not {f"quizgen.{name}" for name in ("figures", "question", "typeset")} & checked
    assert not {"subprocess", "importlib.metadata", "tempfile", "quizgen.bank.rules"} & checked
    assert not ({"sympy"} | DRAWING) & (practised | listed)  # they draw no figure


def test_who_draws_figures_loads_matplotlib_and_nothing_of_its_windows(place):
    found = loaded(
        place,
        "preview point-to-image-plane --seed 1",
        "sheet --topic eye --format html --out sheet",
        "cards --topic eye --format tsv --out cards",
        "export moodle --topic eye --variants 1 --out export",
        "lint --only point-to-image-plane --seeds 3",
    )
    assert len(found) == 5
    assert "matplotlib" in found[0]
    assert "typst" not in found[1]
    assert not {"sympy", "matplotlib.pyplot", "tkinter"} & found[-1]


def test_a_photograph_loads_what_its_effects_need(place):
    plain, flat = loaded(place, "simulate pinhole", "simulate flat")
    assert not {"cv2", "PIL", "numpy.ma", "numpy.random", "quizgen.paper"} & plain
    assert not {"PIL", "numpy.ma", "scipy", "quizgen.paper"} & flat
