"""``quizgen mark``: an answer is an answer, whatever sign it begins with."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner
from sweep import together

import quizgen
from quizgen.cli.mark import mark
from quizgen.core.errors import InvalidChoiceError


@together("typed", ["-0.3", "-3/10", "-.3", "-0,3", "- 0.3", "−0.3"])
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


def mark_lens(*arguments):
    result = CliRunner().invoke(mark, ["thin-lens-image-distance", "--seed", "1", *arguments])
    assert result.exit_code == 0, result.output
    return json.loads(result.output)


@pytest.mark.parametrize(
    ("typed", "verdict", "note"),
    [("102.5 mm behind the lens", "correct", ""), ("not 102.5 mm", "ambiguous", "denied"),
     ("102.5", "partial", "unit-missing")],
)  # fmt: skip
def test_a_part_of_a_template_is_marked(typed, verdict, note):
    """f = 100 mm and an object at 4100 mm: 1/(1/100 - 1/4100) mm is 102.5 mm."""
    found = mark_lens("--part", "a", typed)
    assert (found["verdict"], found["note"]) == (verdict, note)


def test_a_part_that_is_not_there_is_refused():
    result = CliRunner().invoke(mark, ["point-to-image-plane", "--part", "z", "5"])
    assert isinstance(result.exception, InvalidChoiceError)


def test_an_earlier_error_is_carried_forward():
    """f = 75 mm: with an own m = 0.2 the image lies at 75 mm (1 + 0.2) = 90 mm."""
    template = quizgen.builtin_bank().template("magnification-and-object-distance")
    alone = quizgen.mark_part(template, "90 mm", part="b")
    carried = quizgen.mark_part(template, "90 mm", part="b", earlier={"a": "0.2"})
    assert (alone.verdict, alone.credit) == ("wrong", 0)
    assert (carried.note, carried.credit) == ("carried-forward", 1)
