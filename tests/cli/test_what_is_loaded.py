"""Which packages a command loads, from its start to its end: what it loads, everybody waits for."""

from __future__ import annotations

import subprocess
import sys

import pytest
from sweep import spread

from quizgen.bank.bank import builtin_bank

WALK = """
import sys
from quizgen.cli.main import main
try:
    main(sys.argv[1:])
finally:
    print(*sys.modules, file=sys.stderr)
"""
DRAWING = {"numpy", "matplotlib", "PIL"}
"""What only a figure needs."""


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder; solvers are compiled and prose is read, once and for all."""
    list(builtin_bank())
    return tmp_path_factory.mktemp("loaded")


def loaded(place, command, typed=""):
    done = subprocess.run([sys.executable, "-c", WALK, *command.split()], cwd=place, check=True,
                          capture_output=True, text=True, input=typed)  # fmt: skip
    return set(done.stderr.splitlines()[-1].split())


def test_no_command_from_making_a_paper_to_marking_it_loads_sympy(place):
    made = loaded(place, "exam --blueprint trial --seed 3 --out paper")
    assert not {"sympy", "markdown_it", "matplotlib.pyplot"} & made
    assert "matplotlib" in made  # it draws the figures
    assert not {"quizgen.question.levels.guided", "quizgen.question.levels.transfer"} & made
    checked = loaded(place, "check paper/key.json paper/answers.toml")
    assert not ({"sympy", "typst", "markdown_it"} | DRAWING) & checked
    assert not {f"quizgen.{name}" for name in ("figures", "question", "typeset")} & checked
    assert not {"subprocess", "importlib.metadata", "tempfile", "quizgen.bank.rules"} & checked


@pytest.mark.parametrize("command", [
    "practice --topic code --seed 3 --database sqlite:///learnt.sqlite3",
    "templates",
])  # fmt: skip
def test_who_draws_no_figure_loads_nothing_to_draw_with(place, command):
    assert not ({"sympy"} | DRAWING) & loaded(place, command, typed="5\n")


@pytest.mark.parametrize("command", spread([
    "preview point-to-image-plane --seed 1",
    "cards --topic eye --format tsv --out cards",
    "export moodle --topic eye --variants 1 --out export",
    "lint --only point-to-image-plane --seeds 3",
], 1))  # fmt: skip
def test_who_draws_figures_loads_matplotlib_and_nothing_of_its_windows(place, command):
    found = loaded(place, command)
    assert "matplotlib" in found
    assert not {"sympy", "matplotlib.pyplot", "tkinter"} & found


def test_a_formula_sheet_loads_what_its_sketches_are_drawn_with_but_no_sympy(place):
    made = loaded(place, "sheet --topic eye --format html --out sheet")
    assert "matplotlib" in made
    assert not {"sympy", "matplotlib.pyplot", "typst"} & made


def test_a_photograph_loads_what_its_effects_need(place):
    plain = loaded(place, "simulate pinhole")
    assert not {"cv2", "PIL", "numpy.ma", "numpy.random", "quizgen.paper"} & plain
    assert not {"PIL", "numpy.ma", "scipy", "quizgen.paper"} & loaded(place, "simulate flat")
