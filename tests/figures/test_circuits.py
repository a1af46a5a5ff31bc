"""The circuit of docs/figures.md, drawn by schemdraw in the style of the house."""

from __future__ import annotations

import re
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from documented import PAGE

sys.path.insert(0, str(Path(__file__).parents[1] / "bank"))

from mechanics import FILES, write
from needed import without

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.lint.figures import check_figures
from quizgen.question.figure import draw_question_figure

BLOCK = re.compile(r"^```python\n(import schemdraw\n.*?)^```", re.DOTALL | re.MULTILINE)
VALUES = "values = { U = 12, R = 330 }"

# schemdraw finds its fonts in a way that Python gives up.
pytestmark = pytest.mark.filterwarnings("ignore:path is deprecated:DeprecationWarning")


@pytest.fixture
def draws(tmp_path):
    if find_spec("schemdraw") is None:
        without('schemdraw is not installed (pip install "quizgen[circuits]")')
    rules = FILES["templates/forces/push/template.toml"]
    rules = rules.replace('name = "block"\nvalues = { m = "m", F = "F" }', VALUES)
    (figure,) = BLOCK.findall(PAGE.read_text("utf-8"))
    push = "templates/forces/push"
    files = {f"{push}/template.toml": rules, f"{push}/figure.py": figure}
    template = Bank(write(tmp_path, files), trusted=True).template("push")
    return [draw_variant(template, seed) for seed in range(2)]


def test_a_circuit_is_legible_and_hides_what_is_asked(draws):
    assert list(check_figures(draws)) == []
    shown = {
        quiz: [label.text for label in draw_question_figure(draws[0], "en", quiz=quiz).labels]
        for quiz in (True, False)
    }
    assert shown[True] == ["$U$ = 12 V", "$R_1$", "$R_2$ = ?"]
    assert shown[False][-1] == "$R_2$ = 330 Ω"


def test_a_circuit_is_readable_on_a_dark_page(draws):
    svg = draw_question_figure(draws[0], "en", quiz=True).inline_svg.decode()
    assert set(re.findall(r'(?:stroke|fill)="([^"]+)"', svg)) <= {"currentColor", "none"}
