"""``quizgen lint``: every template is examined, whatever is wrong with another."""

from __future__ import annotations

import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from inside import run

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.cli.lint import lint_while_writing
from quizgen.cli.lint_outputs import check_sheet
from quizgen.core.errors import RenderError

RULES = (
    'topic = "x"\ntier = "A"\nsolver = "{name}"\n[draw]\na = {{ pick = [1, 2, 3] }}\n'
    '[[part]]\nanswer = {{ kind = "number", of = "b", exact = true }}\n'
)
PROSE = "# T\nGiven $a$ = {{ a }}.\n## steps\n- b: Twice.\n## check\nEven.\n"
ONE_OF_TWO = '{ kind = "choice", options = { yes = true, no = false } }'
ASKED = (
    "# T\nIs it so?\n## options\n- yes: Yes.\n- no: No.\n## reasons\n- yes: So.\n- no: Not so.\n"
)
BROKEN = {
    "syntax": ("MODEL = (", "syntax.py:1:1: QG136 SyntaxError"),
    "names": (
        "x = 1\nMODEL = nothing",
        "names.py:2:1: QG135 NameError: name 'nothing' is not defined",
    ),
    "division": ("MODEL = 1 / 0", "division.py:1:1: QG133 ZeroDivisionError"),
    "model": ("", "model.py: QG132 no MODEL"),
}
"""Name of a solver to its text and what is said of it."""


@pytest.fixture(scope="module")
def bank(tmp_path_factory):
    root = tmp_path_factory.mktemp("bank")
    (root / "solvers").mkdir()
    for name in (*BROKEN, "good", "zero"):
        folder = root / "templates" / "x" / name
        folder.mkdir(parents=True)
        (folder / "template.toml").write_text(
            f'topic = "x"\ntier = "A"\n[[part]]\nanswer = {ONE_OF_TWO}\n'
        )
        (folder / "en.md").write_text(ASKED)
        if name in BROKEN:
            (folder / "template.toml").write_text(RULES.format(name=name))
            (folder / "en.md").write_text(PROSE)
            (root / "solvers" / f"{name}.py").write_text(BROKEN[name][0])
    (root / "templates" / "x" / "zero" / "template.toml").write_text(
        'topic = "x"\ntier = "A"\n[draw]\na = { range = [15, -15, 1] }\n'
        '[[part]]\nanswer = { kind = "tf", true = "a > 0" }\n'
    )
    return root


def lint(bank, *arguments):
    return subprocess.run(
        [sys.executable, "-m", "quizgen", "lint", str(bank), "--trust", "--seeds", "3", *arguments],
        capture_output=True, text=True, check=False,
    )  # fmt: skip


def test_broken_templates_do_not_stop_the_others(bank):
    done = lint(bank)
    assert done.returncode == 1
    listed = [line.split()[0] for line in done.stdout.splitlines()[1:]]
    assert listed == sorted([*BROKEN, "good", "zero"])
    assert "Traceback" not in done.stderr
    problems = done.stderr.splitlines()
    assert len(problems) == len(BROKEN) + 1
    for name, (_, said) in BROKEN.items():
        assert [line for line in problems if said in line and str(bank) in line], name
    assert [line for line in problems if str(Path("x", "zero")) in line]


def test_debug_shows_the_way_to_an_error(bank):
    done = lint(bank, "--only", "names", "--debug")
    assert "Traceback" in done.stderr
    assert "MODEL = nothing" in done.stderr
    without = lint(bank, "--only", "names").stderr
    assert "Traceback" not in without
    assert without.splitlines() == [done.stderr.splitlines()[-1]]
    assert BROKEN["names"][1] in without


ENDLESS = {
    "solver": "while True:\n    pass\n",
    "caught": "while True:\n    try:\n        x = 1 / 0\n    except Exception:\n        pass\n",
}
"""Solvers that never end; the other one catches all that goes wrong."""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there is no clock to stop them")
@pytest.mark.parametrize("jobs", ["1", "2"])
def test_what_never_ends_is_given_up_and_stops_no_other(bank, tmp_path, jobs):
    root = tmp_path / "bank"
    shutil.copytree(bank / "templates" / "x" / "good", root / "templates" / "x" / "good")
    (root / "solvers").mkdir()
    for name, text in ENDLESS.items():
        shutil.copytree(bank / "templates" / "x" / "model", root / "templates" / "x" / name)
        (root / "templates" / "x" / name / "template.toml").write_text(RULES.format(name=name))
        (root / "solvers" / f"{name}.py").write_text(text)
    done = lint(root, "--jobs", jobs, "--limit", "1")
    assert [line.split()[:2] for line in done.stdout.splitlines()[1:]] == [
        ["caught", "0"], ["good", "3"], ["solver", "0"],
    ]  # fmt: skip
    problems = done.stderr.splitlines()
    assert len(problems) == len(ENDLESS)
    for name, line in zip(ENDLESS, sorted(problems, reverse=True), strict=True):
        assert re.fullmatch(
            rf"{re.escape(str(root))}/solvers/{name}\.py:[1-5]:1: QG602 not done after 1 s; "
            "let every loop end, or give it more time with --limit",
            line,
        )


def test_a_sound_template_is_one_row_and_no_problem(bank):
    done = lint(bank, "--only", "good")
    assert (done.returncode, done.stderr) == (0, "")
    cells = done.stdout.splitlines()[1].split()
    assert (cells[:4], cells[5:]) == (["good", "3", "33%", "100.0%"], ["0", "exact"])


RAISING = """
import quizgen.lint.template_checks as module
def failing(template, *others):
    raise RuntimeError("deep inside")
module.lint_template = failing
from quizgen.cli.main import main
main(["lint", {bank!r}, "--only", "good"])
"""


def test_an_error_nobody_expected_names_its_place(bank):
    done = subprocess.run([sys.executable, "-c", RAISING.format(bank=str(bank))],
                          capture_output=True, text=True, check=False)  # fmt: skip
    assert done.returncode == 1
    assert "RuntimeError: deep inside (in <string>:4; --debug shows" in done.stderr
    assert str(bank / "templates" / "x" / "good") in done.stderr


def test_a_problem_says_where_and_what_to_do(tmp_path):
    folder = tmp_path / "templates" / "x" / "half"
    folder.mkdir(parents=True)
    (tmp_path / "templates" / "bank.toml").write_text(
        'name = "b"\nlanguages = ["en", "bn"]\n[topics]\nx = { en = "X" }\n'
    )
    (folder / "template.toml").write_text(
        f'topic = "x"\ntier = "A"\n[[part]]\nanswer = {ONE_OF_TWO}\n'
    )
    (folder / "en.md").write_text(ASKED)
    done = lint(tmp_path)
    assert done.stderr == (
        f"{folder / 'bn.md'}: QG210 no bn.md; write it, or leave the language out of languages in "
        "bank.toml\n"
    )


@pytest.mark.slow
@pytest.mark.parametrize("what", [("--seeds", "2", "--teach"), ("--seeds", "2")])
def test_any_number_of_processes_finds_the_same(tmp_path, what):
    """But for the time that a draw took."""
    names = ("point-to-image-plane", "thin-lens-image-distance", "no-teaching")
    folder = tmp_path / "templates" / "here"
    for name in names[:2]:
        shutil.copytree(builtin_bank().folder_of(name), folder / name)
    shutil.copytree(folder / names[0], folder / names[2])
    (folder / names[2] / "bn.md").write_text("# x\n## steps\n- f: no step\n")
    shutil.copy(builtin_bank().folder / "bank.toml", tmp_path / "templates")
    found = []
    for jobs in ("1", "3"):
        done = run("lint", str(tmp_path), *what, "--jobs", jobs, cwd=tmp_path)
        told = re.sub(r" +\d+\.\d\d +", " ", done.stdout)
        found.append((done.returncode, told, done.stderr))
    assert found[0] == found[1]
    assert found[0][0] == 1


@pytest.mark.parametrize(
    ("broken", "output"),
    [
        ("quizgen.render.text.format_question", "preview --level exam"),
        ("quizgen.render.html.render_paper_html", "exam html"),
        ("quizgen.render.pdf.render_paper_pdf", "exam pdf"),
        ("quizgen.cards.kinds.question.template_notes", "cards"),
        ("quizgen.web.question_view.run_request", "practice"),
        ("quizgen.lms.moodle.write_moodle", "export moodle"),
        ("quizgen.lms.canvas.write_canvas", "export canvas"),
    ],
)
def test_what_fails_in_one_output_alone_is_told_of_its_template(bank, monkeypatch, broken, output):
    def fail(*given, **named):
        raise AttributeError("'str' object has no attribute 'text'")

    monkeypatch.setattr(broken, fail)
    (said, *_) = lint_while_writing(Bank(bank, trusted=True), "good")
    place = bank / "templates" / "x" / "good" / "template.toml"
    assert said.startswith(f"{place}: QG601 {output}: AttributeError: 'str' object has no")


def test_a_sheet_that_fails_is_told_of_its_file(tmp_path, monkeypatch):
    def fail(sheet):
        raise RenderError("the sheet has no end")

    cards = builtin_bank().folder / "cards" / "formulas.toml"
    (tmp_path / "templates" / "cards").mkdir(parents=True)
    entry = cards.read_text("utf-8").split("[[entry]]")[1]
    (tmp_path / "templates" / "cards" / "formulas.toml").write_text(f"[[entry]]{entry}", "utf-8")
    shutil.copy(builtin_bank().folder / "bank.toml", tmp_path / "templates")
    monkeypatch.setattr("quizgen.render.sheet_pdf.render_sheet_pdf", fail)
    (said,) = check_sheet(Bank(tmp_path, trusted=True))
    assert (said.code, said.file.name) == ("QG601", "formulas.toml")
    assert said.message == "sheet pdf: the sheet has no end"


@pytest.mark.parametrize(
    ("command", "wrong", "line", "said"),
    [
        ("preview", "tier = 'E'", 3, "tier: 'E' is not allowed"),
        ("exam", "tier = 'E'", 3, "tier: 'E' is not allowed"),
        ("preview", "tier = 'A'\nwhere = ['a >']", 4, "formula 'a >'"),
        ("exam", "tier = 'A'\n[keep]\nq = { min = 1 }", 5, "keep names unknown ['q']"),
    ],
)
def test_other_commands_name_the_same_line(tmp_path, command, wrong, line, said):
    folder = tmp_path / "templates" / "x" / "one"
    folder.mkdir(parents=True)
    rules = f"# tier, keep, q and 'a >' are told here\ntopic = 'x'\n{wrong}\n"
    (folder / "template.toml").write_text(f"{rules}[[part]]\nanswer = {ONE_OF_TWO}\n")
    (folder / "en.md").write_text(ASKED)
    what = ["one"] if command == "preview" else ["--topic", "x", "--out", str(tmp_path / "paper")]
    done = run(command, *what, "--bank", str(tmp_path), cwd=tmp_path)
    assert done.returncode == 2
    assert f"{folder / 'template.toml'}:{line}: {said}" in done.stderr
    (told, *_) = lint_while_writing(Bank(tmp_path), "one")
    assert told.startswith(f"{folder / 'template.toml'}:{line}:")
