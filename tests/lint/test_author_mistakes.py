"""Each mistake of an author gets one message, with the place and what mends it."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

sys.path.insert(0, str(Path(__file__).parent))

from author_mistakes import CARD, CARDS, PAGE, ROWS, page, sound, spoilt, write
from checks import AUDIT, Saying, said_by, sayings

from quizgen.bank.bank import Bank
from quizgen.cli.lint import lint
from quizgen.core.errors import BankError


def run(root: Path, *more: str, seeds: int = 20):
    shared = ("--bank", str(root), "--trust", "--seeds", str(seeds))
    return CliRunner().invoke(lint, [*shared, *more], catch_exceptions=False)


def test_without_a_mistake_nothing_is_said(tmp_path):
    done = run(write(tmp_path, {**sound(), CARDS: CARD}))
    assert (done.exit_code, done.stderr) == (0, "")


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row["what"])
def test_a_mistake_gets_one_located_message_that_names_the_mend(tmp_path, row):
    template = row["file"].split("/")
    only = ("--only", template[2] if template[0] == "templates" and template[3:] else "push")
    more = () if row.get("whole") else only
    done = run(spoilt(tmp_path, row), *more, seeds=row.get("seeds", 20))
    assert done.stderr.replace(f"{tmp_path}/", "").splitlines() == [row["says"]]
    assert done.exit_code == 1


OF_QUIZGEN = {
    "a placeholder is left in the question",
    "a placeholder is left in the solution",
    "languages are not marked alike",
    "trap 'added' typed as '6 N' is wrong ()",
    "the right option stands too often or too seldom at [1]",
}
"""What no author can cause: a mistake of quizgen, or of a new answer kind, would be told so."""


def test_every_mistake_is_found_by_a_check_that_is_known():
    assert [row["what"] for row in ROWS if not said_by(row["says"])] == []


def test_every_check_of_lint_finds_a_mistake():
    said = [row["says"] for row in ROWS]
    idle = [one for one in sayings(*AUDIT) if not any(re.search(one.pattern, s) for s in said)]
    needed = [text for text in OF_QUIZGEN if any(re.search(_words(one), text) for one in idle)]
    left = [one for one in idle if not any(re.search(_words(one), text) for text in OF_QUIZGEN)]
    assert (left, sorted(needed)) == ([], sorted(OF_QUIZGEN))


def _words(saying: Saying) -> str:
    """What a message looks like, the seed and the level before it aside."""
    return saying.pattern.removeprefix(r"seed\ .*:\ .*:\ ")


def test_there_are_enough_of_them():
    assert len(ROWS) >= 100
    assert len({row["what"] for row in ROWS}) == len(ROWS)


def test_the_page_is_up_to_date():
    assert PAGE.read_text("utf-8") == page()


PLACED = ("A letter of the solver is not declared", "No points", "A gap has no solution")
"""Mistakes in a solver, in rules and in words."""


@pytest.mark.parametrize("what", PLACED)
@pytest.mark.parametrize("bank", [".", "physics", "../here/physics"])
def test_the_place_is_the_same_wherever_one_stands(tmp_path, monkeypatch, bank, what):
    row = next(row for row in ROWS if row["what"] == what)
    root = spoilt(tmp_path / "here" / "physics", row)
    monkeypatch.chdir(root if bank == "." else root.parent)
    template = row["file"].split("/")[2]
    only = ("--only", template if row["file"].startswith("templates") else "push")
    before = "" if bank == "." else f"{bank}/"
    assert run(Path(bank), *only).stderr.splitlines() == [before + row["says"]]


def test_what_a_solver_prints_is_no_json(tmp_path, empty_cache):
    file = "solvers/forces/newton.py"
    root = write(tmp_path, {**sound(), file: "print('hello')\n" + sound()[file].lstrip()})
    done = run(root, "--json", "--only", "push")
    assert (done.exit_code, done.stdout, done.stderr) == (0, "", "hello\n")


def test_templates_of_one_name_stop_no_other_and_make_no_paper(tmp_path):
    files = sound()
    twin = {f"templates/other/push/{name}": files[f"templates/forces/push/{name}"]
            for name in ("template.toml", "en.md")}  # fmt: skip
    root = write(tmp_path, {**files, **twin})
    done = run(root)
    rows = {line.split()[0]: line.split()[1] for line in done.stdout.splitlines()[1:]}
    assert rows == {name: "0" if name == "push" else "20" for name in rows}
    assert len(rows) == len([name for name in files if name.endswith("template.toml")])
    with pytest.raises(BankError, match=r"forces/push.*'push': also .*other/push"):
        Bank(root, trusted=True).template("push")


def test_a_bank_without_a_question_says_so(tmp_path):
    (tmp_path / "templates").mkdir()
    done = run(tmp_path)
    assert done.exit_code == 1
    assert "the bank has no template; write one with quizgen new template" in done.stderr


def test_editors_get_the_place_as_json(tmp_path):
    row = next(row for row in ROWS if row["what"] == "A unit that nobody has defined")
    (found,) = map(json.loads, run(spoilt(tmp_path, row), "--json").stdout.splitlines())
    assert found["file"] == str(tmp_path / row["file"])
    assert (found["line"], found["template"]) == (7, "push")
    assert found["what"] == "draw.m: unknown unit 'kgg'"
    assert found["mend"].startswith("use a listed one")
