"""What the program prints as the next command works as printed, from where the user stands."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from sweep import spread

ROOT = Path(__file__).parents[2]
OWN = """
[title]
en = "My optics"
[[slot]]
count = 1
topic = "optics"
"""


def shell(line: str, cwd: Path, **extra: str) -> subprocess.CompletedProcess:
    environment = {k: v for k, v in os.environ.items() if not k.startswith("UV")} | extra
    environment["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{environment['PATH']}"
    return subprocess.run(line, shell=True, cwd=cwd, capture_output=True, text=True, check=False,
                          env=environment)  # fmt: skip


def printed(done: subprocess.CompletedProcess) -> tuple[str, str]:
    assert done.returncode == 0, done.stderr
    again = re.search(r"again: (.*)", done.stdout)[1]
    return again, re.search(r"then: (.*)", done.stdout)[1]


@pytest.mark.parametrize(
    "start", spread(["quizgen", f"{shlex.quote(sys.executable)} -m quizgen"], 1)
)
def test_the_commands_work_as_printed_with_an_own_blueprint(tmp_path, start):
    folder = tmp_path / "exam papers"
    folder.mkdir()
    (folder / "mine.toml").write_text(OWN)
    made = shell(f"{start} exam --blueprint mine.toml --format html --seed 3", folder)
    again, check = printed(made)
    assert again.startswith("quizgen " if start == "quizgen" else "python")
    assert "--blueprint mine.toml" in again
    checked = shell(check, folder)
    assert checked.returncode == 0, checked.stderr
    (key,) = folder.glob("exam/*/key.json")
    before = key.read_bytes()
    key.unlink()
    rebuilt = shell(f"{again} --format html", folder)
    assert rebuilt.returncode == 0, rebuilt.stderr
    assert key.read_bytes() == before


@pytest.mark.slow
def test_paths_with_blanks_are_quoted(tmp_path):
    made = shell("quizgen exam --blueprint trial --format html --seed 3 --out 'to night'", tmp_path)
    _, check = printed(made)
    assert "'to night/key.json'" in check
    assert shell(check, tmp_path).returncode == 0


@pytest.mark.slow
def test_an_own_bank_is_named_with_its_trust(tmp_path):
    bank = tmp_path / "my bank"
    bank.mkdir()
    for name in ("templates", "solvers"):
        (bank / name).symlink_to(ROOT / name)
    made = shell("quizgen exam --bank 'my bank' --trust --topic optics --minutes 9 --format html",
                 tmp_path)  # fmt: skip
    again, _ = printed(made)
    assert "--bank 'my bank' --trust" in again
    assert shell(f"{again} --format html", tmp_path).returncode == 0


def with_uv(line: str, cwd: Path) -> subprocess.CompletedProcess:
    """Type a line that begins with uv, which takes this environment as it is."""
    return shell(line, cwd, UV_PROJECT_ENVIRONMENT=sys.prefix, UV_NO_SYNC="1", UV_OFFLINE="1")


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("uv"), reason="uv is not installed")
@pytest.mark.parametrize("form", ["toml", "csv"])
def test_after_uv_run_the_commands_work_as_printed(tmp_path, form):
    made = with_uv(f"uv run --project {shlex.quote(str(ROOT))} quizgen exam --topic eye "
                   f"--minutes 4 --format html --form {form}", tmp_path)  # fmt: skip
    again, check = printed(made)
    assert again.startswith("uv run ")
    assert f"answers.{form}" in check
    for line in (check, f"{again} --format html"):
        done = with_uv(line, tmp_path)
        assert done.returncode == 0, f"{line}\n{done.stderr}"


def test_the_page_of_a_paper_is_checked_as_printed(tmp_path):
    made = shell("quizgen exam --topic eye --minutes 4 --format html --out o", tmp_path)
    code = re.search(r"Code: (\S+)", made.stdout)[1]
    line = re.search(r"save answers.json there, then: (.*)", made.stdout)[1]
    (tmp_path / "o" / "answers.json").write_text(json.dumps({"code": code, "answers": {}}))
    assert shell(line, tmp_path).returncode == 0


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("uv"), reason="uv is not installed")
@pytest.mark.parametrize("lang", ["en", "bn"])
def test_what_the_page_says_after_saving_works_beside_the_key_as_typed(tmp_path, lang):
    made = shell(f"quizgen exam --topic eye --minutes 4 --lang {lang} --format html --out o",
                 tmp_path)  # fmt: skip
    code = re.search(r"Code: (\S+)", made.stdout)[1]
    page = (tmp_path / "o" / "exam.html").read_text(encoding="utf-8")
    told = re.search(r'id="saved" data-text="([^"]*)"', page)[1]
    line = re.search(r"uv run quizgen check key\.json answers\.json", told)[0]
    assert "Next" in told, "who did not start with uv finds the command where it was printed"
    (tmp_path / "o" / "answers.json").write_text(json.dumps({"code": code, "answers": {}}))
    done = with_uv(line, tmp_path / "o")
    assert done.returncode == 0, done.stderr


def test_after_uv_run_the_commands_begin_with_it(tmp_path, monkeypatch):
    from quizgen.cli.terminal import build_command_line

    monkeypatch.setenv("UV_RUN_RECURSION_DEPTH", "1")
    monkeypatch.chdir(ROOT)
    assert build_command_line("check", "a b") == "uv run quizgen check 'a b'"
    monkeypatch.chdir(tmp_path)
    home = Path(sys.prefix).parent
    if (home / "pyproject.toml").exists():
        expected = f"uv run --project {shlex.quote(str(home))} quizgen check x"
        assert build_command_line("check", "x") == expected
