"""Looking at what a class will be asked, and asking something else, before there are papers."""

from __future__ import annotations

import tomllib

import pytest
from made import run

from quizgen.bank.bank import builtin_bank
from quizgen.classes.generation import create_settings
from quizgen.core.errors import BlueprintError
from quizgen.paper.blueprint import load_blueprint

PLAN = """
total = 6
[title]
en = "Two"
[[slot]]
templates = ["rods-cones-and-peaks", "point-to-image-plane", "normalise-from-8-bit-range",
             "exposure-equivalence", "blur-and-light-factors", "uint8-sum-repair"]
count = 2
points = 3
"""


@pytest.fixture
def home(tmp_path):
    (tmp_path / "plan.toml").write_text(PLAN, "utf-8")
    (tmp_path / "roster.csv").write_text("id,name\n7,Ada\n", "utf-8")
    return tmp_path


def make(home, name, *options):
    wished = ("--blueprint", home / "plan.toml", "--out", home / name, "--jobs", 1)
    return run("class", "make", home / "roster.csv", *wished, *options)


def asked(home, name):
    table = tomllib.loads((home / name / "class.toml").read_text("utf-8"))
    return [template for family in table["templates"] for template in family]


def test_a_question_is_asked_instead_of_another_while_there_are_no_papers(home, capsys):
    assert make(home, "class", "--preview") == 0
    first = asked(home, "class")
    said = capsys.readouterr().out
    assert all(name in said for name in first)
    assert "6 points" in said
    assert not (home / "class" / "papers").exists()
    before = (home / "class" / "preview.pdf").read_bytes()
    assert run("class", "redraw", home / "class", 2) == 0
    second = asked(home, "class")
    assert second[0] == first[0]
    assert second[1] not in first
    assert (home / "class" / "preview.pdf").read_bytes() != before
    assert run("class", "redraw", home / "class", 1, "--template", first[1]) == 0
    third = asked(home, "class")
    assert third == [first[1], second[1]]
    assert make(home, "class") == 0
    assert all(name in (home / "class" / "keys.jsonl").read_text("utf-8") for name in third)
    assert run("class", "redraw", home / "class", 1) == 2
    assert "has papers" in capsys.readouterr().err
    assert asked(home, "class") == third


def test_nothing_of_last_year_is_asked_again(home, capsys):
    assert make(home, "first", "--preview") == 0
    assert make(home, "second", "--preview", "--not-from", home / "first") == 0
    old, new = asked(home, "first"), asked(home, "second")
    assert not {*old} & {*new}
    assert run("class", "redraw", home / "second", 1, "--template", old[0]) == 2
    assert "nothing else has the slot" in capsys.readouterr().err
    plan = load_blueprint(str(home / "plan.toml"))
    third = create_settings("third", builtin_bank(), plan, "en", without=(*old, *new))
    assert len({*old, *new, *(name for family in third.templates for name in family)}) == 6
    with pytest.raises(BlueprintError, match="not to be left out"):
        create_settings("fourth", builtin_bank(), plan, "en", without=plan.slot[0].templates)


def test_what_cannot_be_asked_is_said_and_changes_nothing(home, capsys):
    assert make(home, "class", "--preview") == 0
    before = asked(home, "class")
    for words, said in (
        ((3,), "no question 3 (there are 2)"),
        ((0,), "no question 0"),
        ((1, "--template", "nothing-such"), "there is no template 'nothing-such'"),
        ((1, "--template", "rgb-to-hsv"), "nothing else has the slot and the points"),
    ):
        assert run("class", "redraw", home / "class", *words) == 2
        assert said in capsys.readouterr().err
        assert asked(home, "class") == before
