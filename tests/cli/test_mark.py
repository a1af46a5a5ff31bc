"""``quizgen mark``: an answer is an answer, whatever sign it begins with."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner

from quizgen.cli.mark import mark


@pytest.mark.parametrize("typed", ["-0.3", "-3/10", "-.3", "-0,3", "- 0.3", "−0.3"])
def test_a_negative_answer_is_no_option(typed):
    result = CliRunner().invoke(mark, ['{kind="number", value="-0.3"}', typed])
    assert result.exit_code == 0, result.output
    assert json.loads(result.output)["verdict"] == "correct"


def test_options_still_stand_anywhere():
    arguments = ['{kind="number", value="-0.3"}', "--lang", "bn", "-0.5"]
    result = CliRunner().invoke(mark, arguments)
    assert json.loads(result.output)["verdict"] == "wrong"


def test_an_unknown_option_is_an_error():
    result = CliRunner().invoke(mark, ["--lng", '{kind="number", value="-0.3"}', "-0.3"])
    assert result.exit_code == 2
