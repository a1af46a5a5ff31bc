"""``quizgen templates``: found by what they cover."""

from __future__ import annotations

import pytest
from click.testing import CliRunner
from sweep import together

from quizgen.bank.bank import builtin_bank
from quizgen.cli.main import COMMANDS, root_group
from quizgen.cli.templates import templates
from quizgen.lint.coverage import templates_covering


def covers(name):
    return builtin_bank().rules(name).covers


def test_an_item_finds_the_templates_that_claim_it():
    found = templates_covering(builtin_bank(), "Q4a")
    assert found == [name for name in builtin_bank().template_paths if "Q4a" in covers(name)]
    assert found


def test_a_question_finds_its_parts_but_not_a_longer_number():
    found = templates_covering(builtin_bank(), "C12")
    assert found
    for name in builtin_bank().template_paths:
        claimed = {"C12", *(f"C12{letter}" for letter in "abcde")} & set(covers(name))
        assert (name in found) == bool(claimed), name
    assert not [name for name in templates_covering(builtin_bank(), "A1") if not {"A1", "A1a", "A1b", "A1c", "A1d"}
                & set(covers(name))]  # fmt: skip


@pytest.mark.parametrize("item", ["", "(", "Z99", "Q4a.*"])
def test_what_nothing_covers_finds_nothing(item):
    assert templates_covering(builtin_bank(), item) == []
    done = CliRunner().invoke(templates, ["--covers", item])
    assert done.exit_code == 0
    assert f"no template covers {item!r}" in done.output


def rows(*arguments):
    """Cells of each line that is printed where no terminal is."""
    done = CliRunner().invoke(templates, arguments)
    assert done.exit_code == 0, done.output
    return [line.split("\t") for line in done.stdout.splitlines()]


def test_piped_there_is_one_line_of_cells_for_each_template(monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    found = rows()
    assert [row[0] for row in found] == list(builtin_bank().template_paths)
    assert {len(row) for row in found} == {6}
    cells = {row[0]: row for row in found}["bayer-site-counts"]
    assert cells == ["bayer-site-counts", "B", "sensor", "2800", "en,bn", "Counting photosites"]


def test_the_command_prints_name_topic_and_title():
    found = {row[0]: row for row in rows("--covers", "Q4a")}
    assert list(found) == templates_covering(builtin_bank(), "Q4a")
    for name, row in found.items():
        template = builtin_bank().template(name)
        assert (row[2], row[5]) == (template.rules.topic, template.texts["en"].title)


def test_filters_hold_together():
    noise = {row[0] for row in rows("--topic", "Noise")}
    assert noise == {
        n for n in builtin_bank().template_paths if builtin_bank().rules(n).topic == "noise"
    }
    choices = {row[0] for row in rows("--kind", "choice")}
    assert {row[0] for row in rows("--topic", "noise", "--kind", "CHOICE")} == noise & choices
    assert "bayer-site-counts" in {row[0] for row in rows("--search", "PHOTOSITES")}
    assert "bayer-site-counts" in {row[0] for row in rows("--search", "সবুজ photosite")}
    assert rows("--search", "no such words") == []


@pytest.mark.parametrize(("option", "listed"), [("--topic", "projection, "), ("--kind", "angle, ")])
def test_an_unknown_filter_names_what_there_is(option, listed):
    done = CliRunner().invoke(templates, [option, "cooking"])
    assert done.exit_code == 2
    assert listed in done.output


@pytest.fixture
def odd_bank(tmp_path):
    folder = tmp_path / "templates" / "x" / "odd"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(
        'topic = "x"\ntier = "A"\n[[part]]\nanswer = { kind = "tf", true = true }\n'
    )
    return tmp_path


@pytest.mark.parametrize("title", ["Interval [a, b] of values", "Close [/] it", "[link=x]y[/link]"])
@pytest.mark.parametrize("columns", [45, 200])
def test_titles_are_shown_as_they_are(odd_bank, monkeypatch, title, columns):
    (odd_bank / "templates" / "x" / "odd" / "en.md").write_text(f"# {title}\nIs it so?\n")
    assert rows("--bank", str(odd_bank))[0][5] == title
    for module in ("templates", "terminal"):
        monkeypatch.setattr(f"quizgen.cli.{module}.is_interactive", lambda: True)
    monkeypatch.setenv("COLUMNS", str(columns))
    done = CliRunner().invoke(templates, ["--bank", str(odd_bank)])
    assert title in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= columns


@together("name", COMMANDS)
def test_every_command_stands_in_the_module_of_its_name(name):
    module, line = COMMANDS[name]
    # No module can be imported by a keyword's name.
    assert module == f"quizgen.cli.{'classes' if name == 'class' else name}"
    done = CliRunner().invoke(root_group, [name, "--help"])
    assert done.exit_code == 0
    assert line
