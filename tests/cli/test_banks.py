"""Whose Python may run: asked once, remembered until it changes; banks that packages bring."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

sys.path.insert(0, str(Path(__file__).parents[1] / "bank"))

from mechanics import FILES, write

from quizgen.bank import discovery
from quizgen.cli import options
from quizgen.cli.main import root_group

SOLVER = "solvers/forces/newton.py"


@pytest.fixture
def root(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "home"))
    monkeypatch.chdir(tmp_path)
    return write(tmp_path / "mechanics")


def run(*arguments, typed: str | None = None):
    return CliRunner().invoke(root_group, [*map(str, arguments)], input=typed)


class _Terminal:
    """A stream that people sit at."""

    def __init__(self, stream):
        self.stream = stream

    def __getattr__(self, name):
        return getattr(self.stream, name)

    def isatty(self):
        return True


@pytest.fixture
def asked(monkeypatch):
    """Somebody who answers what they are asked."""
    answers, questions = [], []

    def confirm(question, **_kwargs):
        questions.append(question)
        return answers.pop(0)

    monkeypatch.setattr(options.click, "confirm", confirm)
    monkeypatch.setattr(
        options,
        "sys",
        type("S", (), {"stdin": _Terminal(sys.stdin), "stderr": _Terminal(sys.stderr)}),
    )
    return answers, questions


def test_what_does_not_run_is_said_at_once(root):
    done = run("preview", "push", "--bank", root)
    assert done.exception is not None
    assert done.stderr.startswith(
        f"quizgen: {root} brings 2 files of Python, such as newton.py; it does not run without --trust\n"
    )
    assert run("templates", "--bank", root).exit_code == 0


def test_who_allows_it_is_asked_once_until_it_changes(root, asked):
    answers, questions = asked
    answers += [False, True]
    assert run("preview", "push", "--bank", root).exit_code != 0
    assert run("preview", "push", "--bank", root).exit_code == 0
    assert run("preview", "push", "--bank", root).exit_code == 0
    assert len(questions) == 2
    (root / SOLVER).write_text(FILES[SOLVER] + "\n# changed\n", "utf-8")
    answers.append(False)
    assert run("preview", "push", "--bank", root).exit_code != 0
    assert len(questions) == 3


@pytest.mark.parametrize(
    "name", ["solvers/more.py", "templates/figures/more.py", "templates/push/figure.py"]
)
def test_all_python_that_could_run_is_asked_for(root, name):
    discovery.remember_trust(root)
    assert discovery.is_trust_remembered(root)
    (root / name).parent.mkdir(parents=True, exist_ok=True)
    (root / name).write_text("import os\n")
    assert not discovery.is_trust_remembered(root)


def test_to_trust_for_once_is_not_remembered(root):
    assert run("preview", "push", "--bank", root, "--trust").exit_code == 0
    assert not discovery.is_trust_remembered(root)


@pytest.fixture
def package(root, tmp_path, monkeypatch):
    """The bank as an installed package brings it."""
    site = tmp_path / "site"
    shutil.copytree(root, site / "bank_of_mechanics")
    (site / "bank_of_mechanics" / "__init__.py").write_text("raise RuntimeError('imported')\n")
    info = site / "mechanics-1.2.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: mechanics\nVersion: 1.2\n")
    (info / "entry_points.txt").write_text("[quizgen.banks]\nforces101 = bank_of_mechanics\n")
    monkeypatch.syspath_prepend(site)
    discovery.installed_banks.cache_clear()
    yield site / "bank_of_mechanics"
    discovery.installed_banks.cache_clear()


@pytest.mark.parametrize("name", ["mechanics", "forces101"], ids=["bank.toml", "entry point"])
def test_a_package_brings_a_bank_by_its_name(package, tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path / "site")
    (tmp_path / "site" / name).mkdir()  # a folder of that name, and no bank
    done = run("preview", "push", "--bank", name, "--trust")
    assert done.exit_code == 0
    assert "A push" in done.output


def test_a_package_cannot_take_the_name_of_another_bank(package, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path / "site")
    about = package / "templates/bank.toml"
    for said in ('name = "image-acquisition"', 'name = ""', "name = ["):
        about.write_text(said, "utf-8")
        assert discovery.available_banks() == {
            "image-acquisition": discovery.builtin_root(), "forces101": package}  # fmt: skip


def test_an_installed_bank_stays_trusted_until_its_python_changes(package, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path / "site")
    assert run("preview", "push", "--bank", "mechanics").exit_code != 0
    done = run("banks", "--bank", "mechanics", "--remember")
    assert done.exit_code == 0, done.output
    assert "  runs  " in done.stdout.splitlines()[-1]
    assert run("preview", "push", "--bank", "mechanics").exit_code == 0
    # Another version in another environment, with the same Python.
    moved = shutil.copytree(package, tmp_path / "elsewhere")
    (moved / "templates/bank.toml").write_text(FILES["templates/bank.toml"].replace("1.2", "1.3"))
    assert run("preview", "push", "--bank", moved).exit_code == 0
    (moved / SOLVER).write_text(FILES[SOLVER] + "\n# changed\n", "utf-8")
    assert run("preview", "push", "--bank", moved).exit_code != 0


def test_there_is_nothing_to_remember_without_a_bank(root):
    done = run("banks", "--remember")
    assert done.exit_code == 2
    assert "--bank" in done.output


def test_banks_are_listed_with_what_they_are(package):
    rows = [re.split(" {2,}", line) for line in run("banks").output.splitlines()]
    (own,) = [row for row in rows if row[0] == "mechanics"]
    assert own[1:] == ["1.2", "en", "1", "needs --trust", "CC BY 4.0", str(package)]
    discovery.remember_trust(package)
    assert "  runs  " in run("banks").output.splitlines()[-1]
    assert any(row[0] == "image-acquisition" for row in rows)


def test_each_of_several_banks_is_asked_for(root, tmp_path, asked):
    answers, questions = asked
    second = write(tmp_path / "second")
    about = second / "templates" / "bank.toml"
    about.write_text(FILES["templates/bank.toml"].replace('"mechanics"', '"second"'), "utf-8")
    (second / SOLVER).write_text(FILES[SOLVER] + "\n# another\n", "utf-8")
    both = ("--bank", "image-acquisition", "--bank", root, "--bank", second)
    answers += [True, False]
    assert run("preview", "mechanics:push", *both).exit_code == 0
    assert [str(one) in said for one, said in zip((root, second), questions, strict=True)] == [
        True, True,
    ]  # fmt: skip
    assert (discovery.is_trust_remembered(root), discovery.is_trust_remembered(second)) == (
        True,
        False,
    )
    answers.append(False)
    done = run("preview", "second:push", *both)
    assert str(second) in str(done.exception)
    assert len(questions) == 3


@pytest.fixture
def second(root, tmp_path):
    """Another bank, with Python of its own that differs."""
    place = write(tmp_path / "second")
    about = place / "templates" / "bank.toml"
    about.write_text(FILES["templates/bank.toml"].replace('"mechanics"', '"second"'), "utf-8")
    (place / SOLVER).write_text(FILES[SOLVER] + "\n# another\n", "utf-8")
    return place


def test_of_two_banks_one_is_trusted(root, second):
    both = ("--bank", root, "--bank", second)
    only = (*both, "--trust-bank", root)
    done = run("preview", "mechanics:push", *only)
    assert done.exit_code == 0, done.output
    assert f"{second} brings 2 files of Python" in done.stderr
    assert str(root) not in done.stderr
    done = run("preview", "second:push", *only)
    assert str(done.exception).startswith(f"{second / SOLVER}: this bank brings its own Python")
    made = run("exam", *both, "--trust-bank", second, "--blueprint", "all.90", "--format", "html",
               "--out", "paper")  # fmt: skip
    assert str(made.exception).startswith(f"{root / SOLVER}: this bank brings its own Python")
    assert not Path("paper").exists()


def test_to_trust_all_names_each(root, second):
    all_of_them = ("--bank", "image-acquisition", "--bank", root, "--bank", second, "--trust")
    done = run("preview", "second:push", *all_of_them)
    assert done.exit_code == 0
    assert done.stderr == f"quizgen: --trust lets the Python of 2 banks run: {root}, {second}\n"
    assert run("preview", "push", "--bank", root, "--trust").stderr == ""


def test_who_is_trusted_must_be_among_the_banks(root, second):
    done = run("preview", "push", "--bank", root, "--trust-bank", second)
    assert done.exit_code == 2
    assert f"{second} is not among the banks of --bank ({root})" in done.output.replace("\n", " ")


def test_a_command_to_make_it_again_trusts_the_same_bank(root):
    done = run("exam", "--bank", root, "--trust-bank", root, "--topic", "forces",
               "--format", "html", "--out", "paper")  # fmt: skip
    assert done.exit_code == 0, done.output
    (again,) = [line for line in done.output.splitlines() if "paper again" in line]
    assert f"--trust-bank {root}" in again
    assert " --trust " not in f"{again} "
