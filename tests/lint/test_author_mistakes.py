"""Each mistake of an author gets one message, with the place and what mends it."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from sweep import spread

sys.path.insert(0, str(Path(__file__).parent))

from author_mistakes import CARD, CARDS, PAGE, ROWS, code_of, page, sound, spoilt, write

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.cli.lint import lint
from quizgen.core.diagnostics import CODES
from quizgen.core.errors import BankError


def run(root: Path, *more: str, seeds: int = 6):
    shared = ("--bank", str(root), "--trust", "--seeds", str(seeds))
    return CliRunner().invoke(lint, [*shared, *more], catch_exceptions=False)


def test_without_a_mistake_nothing_is_said(tmp_path):
    done = run(write(tmp_path, {**sound(), CARDS: CARD}))
    assert (done.exit_code, done.stderr) == (0, "")


@pytest.mark.parametrize("row", spread(ROWS, 30), ids=lambda row: row["what"])
def test_a_mistake_gets_one_located_message_that_names_the_mend(tmp_path, row):
    template = row["file"].split("/")
    only = ("--only", template[2] if template[0] == "templates" and template[3:] else "push")
    more = () if row.get("whole") else only
    done = run(spoilt(tmp_path, row), *more, seeds=row.get("seeds", 6))
    assert done.stderr.replace(f"{tmp_path}/", "").splitlines() == [row["says"]]
    assert done.exit_code == 1


NOT_HERE = {
    "QG100": "an error that has no code of its own",
    "QG128": "a bank that is not trusted: tests/cli/test_banks.py",
    "QG204": "no author can cause it: a mistake of quizgen or of a new answer kind",
    "QG206": "the same",
    "QG209": "the same",
    "QG302": "the same",
    "QG307": "said by --teach alone: tests/lint/test_teach.py",
    "QG308": "the same",
    "QG313": "the same",
    "QG314": "the same",
    "QG315": "the same",
    "QG320": "blueprints: tests/paper/test_quota.py",
    "QG321": "the same",
    "QG322": "the same",
    "QG323": "the same",
    "QG507": "words of a language that a bank brings: tests/bank/test_brought_language.py",
    "QG508": "the same",
    "QG601": "an output that fails: tests/cli/test_lint_command.py",
    "QG602": "a solver that never ends: tests/cli/test_lint_command.py",
    "QG603": "an error of quizgen itself: tests/cli/test_lint_command.py",
    "QG610": "about scanned sheets: tests/classes/test_scan.py",
    "QG611": "the same",
    "QG612": "the same",
    "QG613": "the same",
    "QG650": "files of a class: tests/web/test_marking_page.py",
    "QG651": "the same",
}
"""Codes that no single change to the files of a sound bank brings about, and why."""


def test_every_code_is_said_of_a_mistake():
    assert CODES.keys() - {code_of(row) for row in ROWS} == NOT_HERE.keys()


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
    assert rows == {name: "0" if name == "push" else "6" for name in rows}
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
    assert (found["code"], found["line"], found["column"]) == ("QG122", 7, 1)
    assert found["message"] == "draw.m: unknown unit 'kcrr'"
    assert found["hint"].startswith("use a listed one")


def test_a_comment_does_not_stand_for_the_key_it_speaks_of(tmp_path):
    """Positions come from the keys, not from words that happen to be alike."""
    files = sound()
    rules = "templates/forces/push/template.toml"
    files[rules] = (
        "# the time 'Q' is kept below, keep.Q = 1\n" + files[rules] + "[keep]\nQ = { min = 1 }\n"
    )
    (said,) = run(write(tmp_path, files), "--only", "push").stderr.splitlines()
    line = files[rules].splitlines().index("Q = { min = 1 }") + 1
    assert line > 2
    assert said.startswith(f"{tmp_path / rules}:{line}:1: QG116 keep names unknown ['Q']")


CONSTANT = "The answer is always the same"


def ignoring(root: Path, *codes: str) -> Path:
    """The bank with the mistake above, whose template asks not to be told of some codes."""
    row = next(row for row in ROWS if row["what"] == CONSTANT)
    file = spoilt(root, row) / row["file"]
    listed = ", ".join(f'"{code}"' for code in codes)
    file.write_text(f"ignore = [{listed}]\n{file.read_text('utf-8').lstrip()}", "utf-8")
    return root


def test_a_template_may_ask_not_to_be_told_of_a_code(tmp_path):
    done = run(ignoring(tmp_path / "all", "QG301"), "--only", "push")
    assert [line.split()[1] for line in done.stderr.splitlines()] == ["QG208"]
    done = run(ignoring(tmp_path / "less", "QG208"), "--only", "push")
    assert (done.exit_code, done.stderr) == (0, "")


@pytest.mark.parametrize(
    ("code", "said"),
    [
        ("QG999", "there is no code 'QG999'"),
        ("QG121", "QG121 cannot be ignored: it stops a paper"),
        ("all", "there is no code 'all'"),
    ],
)
def test_what_cannot_be_ignored_is_itself_told(tmp_path, code, said):
    done = run(ignoring(tmp_path, code), "--only", "push")
    place = f"{tmp_path}/templates/forces/push/template.toml:1:11"
    assert done.stderr.startswith(f"{place}: QG119 ignore 1: {said}")


def test_what_is_ignored_changes_no_number(tmp_path):
    before = Bank(write(tmp_path / "a", sound()), trusted=True).template("push")
    files = sound()
    rules = "templates/forces/push/template.toml"
    files[rules] = 'ignore = ["QG208"]\n' + files[rules].lstrip()
    after = Bank(write(tmp_path / "b", files), trusted=True).template("push")
    assert draw_variant(before, 7).shown == draw_variant(after, 7).shown
