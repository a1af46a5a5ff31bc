"""Several banks on the command line: papers of both, whose Python runs, which ones differ."""

from __future__ import annotations

import json
import re
import shutil
import sys
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

sys.path.insert(0, str(Path(__file__).parents[1] / "bank"))

from mechanics import FILES, write

from quizgen.bank.bank import builtin_bank
from quizgen.classes.generation import open_class_bank
from quizgen.cli.main import root_group
from quizgen.core.errors import QuizgenError

OURS = builtin_bank().name
SOLVER = "solvers/forces/newton.py"
RAN = "from pathlib import Path\nPath({!r}).touch()\n"
PLAN = """
title.en = "Both"
[[slot]]
templates = ["push"]
[[slot]]
templates = ["stored-values-and-bytes"]
"""


@pytest.fixture
def root(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "home"))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "both.toml").write_text(PLAN, "utf-8")
    return write(tmp_path / "mechanics")


def run(*arguments):
    return CliRunner().invoke(root_group, [*map(str, arguments)])


def exam(root, *more):
    return run("exam", "--bank", OURS, "--bank", root, "--trust", "--format", "html",
               "--blueprint", "both.toml", "--out", "paper", *more)  # fmt: skip


def commands(found: click.Command, words: tuple[str, ...] = ()):
    yield words, found
    if isinstance(found, click.Group):
        context = click.Context(found)
        for name in found.list_commands(context):
            yield from commands(found.get_command(context, name), (*words, name))


def test_every_command_that_takes_a_bank_takes_trust_and_several():
    taking = {}
    for words, command in commands(root_group):
        options = {name: one for one in command.params for name in one.opts}
        if "--bank" in options:
            assert "--trust" in options, words
            taking[" ".join(words)] = options["--bank"].multiple
            assert ("--trust-bank" in options) is options["--bank"].multiple, words
    alone = {"new template", "new language"}  # write into one bank
    assert {name for name, several in taking.items() if not several} == alone
    assert taking.keys() - alone == {
        "exam", "check", "mark", "practice", "class make", "cards", "sheet", "export", "serve",
        "templates", "preview", "banks", "lint",
    }  # fmt: skip


def test_a_paper_of_two_banks_names_both(root):
    assert exam(root, "--seed", 1).exit_code == 0
    key = json.loads(Path("paper/key.json").read_text("utf-8"))
    assert [one["template"] for one in key["questions"]] == ["push", "stored-values-and-bytes"]
    told = {one["name"]: (one["version"], one["templates"]) for one in key["banks"]}
    assert told == {"mechanics": ("1.2", ["push"]), OURS: ("1.0", ["stored-values-and-bytes"])}
    page = Path("paper/exam.html").read_text("utf-8")
    assert "A block of" in page
    again = run("exam", "--code", key["code"], "--blueprint", "both.toml", "--bank", OURS,
                "--bank", root, "--trust", "--format", "html", "--out", "again")  # fmt: skip
    assert again.exit_code == 0
    assert Path("again/exam.html").read_text("utf-8") == page


def test_a_check_with_another_bank_says_which_and_marks(root, tmp_path):
    exam(root, "--seed", 1)
    check = ("check", "paper/key.json", "paper/answers.toml")
    plain = run(*check)
    assert plain.stderr == ""
    same = run(*check, "--bank", root)
    assert (same.stdout, same.stderr) == (plain.stdout, "")
    prose = root / "templates/forces/push/en.md"
    prose.write_text(prose.read_text("utf-8").replace("A push", "A pull"), "utf-8")
    about = root / "templates/bank.toml"
    for version, said in (("1.2", "other files here than on the paper, of the same version"),
                          ("1.3", "version 1.3 here, 1.2 on the paper")):  # fmt: skip
        about.write_text(FILES["templates/bank.toml"].replace("1.2", version), "utf-8")
        done = run(*check, "--bank", root)
        assert done.exit_code == 0
        assert done.stdout == plain.stdout
        assert done.stderr == f"quizgen: mechanics: {said}; marked by the key\n"
    shutil.rmtree(root / "templates/forces/push")
    about.write_text(FILES["templates/bank.toml"], "utf-8")
    assert "mechanics: no template 'push' here" in run(*check, "--bank", root).stderr


def test_a_key_from_before_names_no_bank_and_marks(root):
    exam(root, "--seed", 1)
    key = Path("paper/key.json")
    table = json.loads(key.read_text("utf-8"))
    del table["banks"]
    key.write_text(json.dumps(table), "utf-8")
    done = run("check", key, "paper/answers.toml", "--bank", root)
    assert (done.exit_code, done.stderr) == (0, "")


def test_a_paper_that_cannot_be_made_again_says_which_bank_differs(root):
    exam(root, "--seed", 1)
    code = json.loads(Path("paper/key.json").read_text("utf-8"))["code"]
    prose = root / "templates/forces/push/en.md"
    prose.write_text(prose.read_text("utf-8").replace("A push", "A pull"), "utf-8")
    again = CliRunner().invoke(
        root_group, ["exam", "--code", code, "--blueprint", "both.toml", "--bank", OURS,
                "--bank", str(root), "--trust", "--out", "paper"],
    )  # fmt: skip
    assert isinstance(again.exception, QuizgenError)
    assert str(again.exception).endswith(
        "; mechanics: other files here than on the paper, of the same version"
    )
    assert "\n" not in str(again.exception)
    marks = run("check", "paper/key.json", "paper/answers.toml", "--json").stdout
    Path("marks.json").write_text(marks, "utf-8")
    cards = run("cards", "--from-marks", "marks.json", "--blueprint", "both.toml",
                "--bank", OURS, "--bank", root, "--trust")  # fmt: skip
    assert str(cards.exception).endswith(
        "; mechanics: other files here than on the paper, of the same version"
    )


def test_the_python_of_a_bank_that_nobody_trusts_never_runs(root, tmp_path):
    ran = tmp_path / "ran"
    for file in (SOLVER, "templates/figures/block.py"):
        (root / file).write_text(RAN.format(str(ran)) + FILES[file], "utf-8")
    both = ("--bank", OURS, "--bank", root)
    for words in (
        ("exam", "--blueprint", "both.toml", "--out", "paper"),
        ("preview", "push"),
        ("cards", "--topic", "forces", "--kind", "question", "--out", "cards"),
        ("export", "moodle", "--template", "push", "--out", "x.xml"),
        ("lint", "--seeds", "2", "--only", "push"),
        ("practice", "--topic", "forces", "--database", "sqlite:///p.sqlite3"),
        ("templates",),
        ("check", "key.json", "answers.toml"),
    ):
        done = run(*words, *both)
        assert not ran.exists(), words
        if words[0] != "check":  # which runs nothing at all
            assert f"{root} brings 2 files of Python" in done.stderr, words
            assert "it does not run without --trust" in done.stderr
    assert run("preview", "push", *both, "--trust").exit_code == 0
    assert ran.exists()


def test_an_export_of_two_banks_names_both_and_says_which_differs(root):
    both = ("--bank", OURS, "--bank", root)
    made = run("export", "moodle", "--template", "push,stored-values-and-bytes", "--variants", 1,
               "--out", "two.txt", "--trust", *both)  # fmt: skip
    assert made.exit_code == 0, made.output
    head = json.loads(Path("two.txt.keys.jsonl").read_text("utf-8").splitlines()[0])
    told = {one["name"]: (one["version"], one["templates"]) for one in head["banks"]}
    assert told == {"mechanics": ("1.2", ["push"]), OURS: ("1.0", ["stored-values-and-bytes"])}
    Path("none.json").write_text("[]", "utf-8")
    check = ("check", "two.txt.keys.jsonl", "none.json")
    same = run(*check, *both).stderr
    prose = root / "templates/forces/push/en.md"
    prose.write_text(prose.read_text("utf-8").replace("A push", "A pull"), "utf-8")
    differs = "mechanics: other files here than on the paper, of the same version"
    assert run(*check, *both).stderr == f"quizgen: {differs}; marked by the key\n{same}"
    assert "mechanics" not in same


def test_what_is_listed_and_proved_of_two_banks(root):
    both = ("--bank", OURS, "--bank", root, "--trust")
    assert re.match("push\tA\tforces", run("templates", "--topic", "Forces", *both).stdout)
    holes = run("templates", "--coverage", *both)
    assert holes.exit_code == 0
    done = run("lint", "--only", "push", "--seeds", "3", *both)
    assert done.exit_code == 0
    assert "push" in done.stdout
    assert "stored-values" not in done.stdout
    assert [row.split()[0] for row in run("banks", *both).stdout.splitlines()[1:]] == [
        OURS, "mechanics",
    ]  # fmt: skip


def test_a_class_of_two_banks(root):
    Path("roster.csv").write_text("id,name\nS1,A. Student\n", "utf-8")
    make = ("class", "make", "roster.csv", "--out", "class", "--jobs", "1")
    both = ("--bank", OURS, "--bank", root, "--trust", "--blueprint", "both.toml")
    done = run(*make, *both)
    assert done.exit_code == 0, done.output
    line = json.loads(Path("class/keys.jsonl").read_text("utf-8"))
    assert {one["name"] for one in line["key"]["banks"]} == {OURS, "mechanics"}
    assert "1 kept as they were" in run(*make).output
    other = run(*make, "--bank", root)
    assert "was made with bank" in str(other.exception)
    prose = root / "templates/forces/push/en.md"
    prose.write_text(prose.read_text("utf-8").replace("A push", "A pull"), "utf-8")
    open_class_bank.cache_clear()  # another process would open the bank anew
    assert "(mechanics: other files here" in str(run(*make).exception)


def test_a_class_from_before_is_read(root):
    Path("roster.csv").write_text("id,name\nS1,A. Student\n", "utf-8")
    Path("one.toml").write_text(PLAN.rpartition("[[slot]]")[0], "utf-8")
    make = ("class", "make", "roster.csv", "--out", "class", "--jobs", "1")
    run(*make, "--bank", root, "--trust", "--blueprint", "one.toml")
    settings = Path("class/class.toml")
    now = f'banks = [["{root}", true]]'
    told = settings.read_text("utf-8")
    assert now in told
    settings.write_text(told.replace(now, f'bank = "{root}"\ntrust = true'), "utf-8")
    assert "1 kept as they were" in run(*make).output
