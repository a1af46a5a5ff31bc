"""Built-in templates without guided and transfer questions: each has a reason, and none more."""

from __future__ import annotations

import tomllib
from pathlib import Path

from quizgen.bank.bank import builtin_bank

REASONS = tomllib.loads(Path(__file__).with_name("without_levels.toml").read_text("utf-8"))


def test_each_has_a_reason_and_no_other_template_has_one():
    without = {
        name for name in builtin_bank().template_paths if not builtin_bank().rules(name).levels
    }
    assert without == set(REASONS)


def test_none_of_them_could_ask_its_steps_from_the_page():
    """What is read in a figure by its number would be listed in ``reads``, and steps begin there."""
    for name in REASONS:
        figure = builtin_bank().rules(name).figure
        assert figure is None or not figure.reads
