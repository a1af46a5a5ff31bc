"""``quizgen templates``: found by what they cover."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from quizgen.audit.coverage import covering
from quizgen.bank.folder import builtin
from quizgen.cli.main import COMMANDS, group
from quizgen.cli.templates import templates


def covers(name):
    return builtin().rules(name).covers


def test_an_item_finds_the_templates_that_claim_it():
    found = covering(builtin(), "Q4a")
    assert found == [name for name in builtin().paths if "Q4a" in covers(name)]
    assert found


def test_a_question_finds_its_parts_but_not_a_longer_number():
    found = covering(builtin(), "C12")
    assert found
    for name in builtin().paths:
        claimed = {"C12", *(f"C12{letter}" for letter in "abcde")} & set(covers(name))
        assert (name in found) == bool(claimed), name
    assert not [name for name in covering(builtin(), "A1") if not {"A1", "A1a", "A1b", "A1c", "A1d"}
                & set(covers(name))]  # fmt: skip


@pytest.mark.parametrize("item", ["", "(", "Z99", "Q4a.*"])
def test_what_nothing_covers_finds_nothing(item):
    assert covering(builtin(), item) == []
    done = CliRunner().invoke(templates, ["--covers", item])
    assert done.exit_code == 0
    assert f"no template covers {item!r}" in done.output


def test_the_command_prints_name_topic_and_title(monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    done = CliRunner().invoke(templates, ["--covers", "Q4a"])
    for name in covering(builtin(), "Q4a"):
        template = builtin().template(name)
        (row,) = [line for line in done.output.splitlines() if f" {name} " in line]
        assert template.rules.topic in row
        assert template.texts["en"].title in row


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_stands_in_the_module_of_its_name(name):
    module, line = COMMANDS[name]
    assert module == f"quizgen.cli.{name}"
    done = CliRunner().invoke(group, [name, "--help"])
    assert done.exit_code == 0
    assert line
