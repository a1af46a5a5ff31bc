"""What only a server, a class, a printer or a cluster needs is an extra, and commands say which.

A package counts as missing where its import is blocked: ``None`` in ``sys.modules`` is what Python
itself takes for a module that must not be imported.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

from quizgen.core.errors import EXTRA_MODULES

ROOT = Path(__file__).parent.parent
TABLE = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
EXTRAS = TABLE["project"]["optional-dependencies"]
ALL = [module for modules in EXTRA_MODULES.values() for module in modules]

RUN = """
import sys
blocked = {blocked!r}
sys.modules.update(dict.fromkeys(blocked))
from quizgen.__main__ import main
sys.argv[0] = "quizgen"
main()
"""


def run_without(modules, *words, cwd, typed=""):
    """A command where these modules cannot be imported."""
    code = RUN.format(blocked=list(modules))
    own = dict.fromkeys(("XDG_CONFIG_HOME", "XDG_DATA_HOME"), str(cwd))
    return subprocess.run(
        [sys.executable, "-c", code, *map(str, words)],
        cwd=cwd, env=os.environ | own, input=typed, capture_output=True, text=True, check=False,
    )  # fmt: skip


def name_of(requirement: str) -> str:
    return re.split(r"[\[>=<]", requirement)[0]


def test_the_extras_bring_what_is_imported_of_them():
    brought = packages_distributions()
    for extra, requirements in EXTRAS.items():
        imported = {brought[module][0].lower() for module in EXTRA_MODULES[extra]}
        assert imported == {name_of(one) for one in requirements} - {"quizgen"}, extra
    assert EXTRAS.keys() == EXTRA_MODULES.keys()


def test_nothing_of_an_extra_is_needed_by_the_core():
    core = {name_of(one) for one in TABLE["project"]["dependencies"]}
    assert not core & {name_of(one) for row in EXTRAS.values() for one in row}


def test_the_page_has_what_each_extra_brings():
    text = (ROOT / "docs" / "commands.md").read_text("utf-8")
    table = dict(
        re.findall(r"^\| `([a-z]+)`(?:, `anki`)? \| ([a-zA-Z0-9,` -]+) \| ", text, re.MULTILINE)
    )
    for extra in EXTRAS.keys() - {"lms", "anki"}:
        told = re.findall(r"[a-z0-9-]+", table[extra].partition(", and all of")[0])
        assert {*told} == {name_of(one) for one in EXTRAS[extra]} - {"quizgen"}, extra


def test_developers_get_every_extra():
    (own,) = (one for one in TABLE["dependency-groups"]["dev"] if name_of(one) == "quizgen")
    assert own == f"quizgen[{','.join(EXTRAS)}]"


def _own_modules(extra: str) -> list[str]:
    """What an extra brings and no other one: some share a package."""
    return [one for one in EXTRA_MODULES[extra] if ALL.count(one) == 1]


@pytest.mark.parametrize(
    ("extra", "words", "feature"),
    [
        ("web", "serve --no-open", "quizgen serve"),
        ("web", "practice --database sqlite:///own.sqlite3", "quizgen practice --database"),
        ("class", "class mark midterm", "quizgen class"),
        ("class", "serve --no-open --class .", "quizgen serve --class"),
        ("print", "class make roster.csv --out midterm --one-file",
         "quizgen class make --one-file"),
        ("scan", "class scan midterm a.pdf", "quizgen class scan"),
        ("postgres", "practice --database postgresql+psycopg://me@localhost/quiz",
         "a database of PostgreSQL"),
        ("cluster", "class make roster.csv --out midterm --scheduler tcp://localhost:8786",
         "--scheduler"),
    ],
)  # fmt: skip
def test_a_command_without_its_extra_says_what_to_type(tmp_path, extra, words, feature):
    (tmp_path / "roster.csv").write_text("id,name\n1,Ada\n", "utf-8")
    done = run_without(_own_modules(extra), *words.split(), cwd=tmp_path)
    assert done.returncode == 2
    line = f'quizgen: {feature} needs more packages; type: pip install "quizgen[{extra}]"\n'
    assert done.stderr == line
    assert done.stdout == ""
    assert not (tmp_path / "midterm").exists()


WITHOUT_EXTRAS = """
cards --topic eye --format tsv --out cards
lint --only point-to-image-plane --seeds 2
preview point-to-image-plane
sheet --topic eye --format html --out sheet
simulate pinhole --out photo.png
tradeoff --out tradeoff
export qti3 --topic eye --variants 1 --out eye.zip
class --help
exam --seed 3 --blueprint trial --out paper
check paper/key.json paper/answers.toml
practice --topic eye --count 1 --fresh
"""
"""The last one says what it keeps; each has its exit code in a line of its own."""
RUN_ALL = """
import sys
sys.modules.update(dict.fromkeys({blocked!r}))
from quizgen.cli.main import main
for words in {commands!r}:
    try:
        main(words.split())
        code = 0
    except SystemExit as end:
        code = end.code
    print("ended", code or 0, words, file=sys.stderr)
"""


def test_the_doctor_lists_the_extras_that_are_there(tmp_path):
    done = run_without(_own_modules("web") + _own_modules("print"), "doctor", cwd=tmp_path)
    extras = "class, lms, anki, postgres, cluster, image, scan, circuits, irt"
    assert f"ok  extras: {extras}\n" in done.stdout


@pytest.mark.slow
def test_commands_work_without_extras(tmp_path):
    """In one process, where nothing of an extra can be imported."""
    commands = WITHOUT_EXTRAS.strip().splitlines()
    own = dict.fromkeys(("XDG_CONFIG_HOME", "XDG_DATA_HOME"), str(tmp_path))
    done = subprocess.run(
        [sys.executable, "-c", RUN_ALL.format(blocked=ALL, commands=commands)],
        cwd=tmp_path, env=os.environ | own, input="skip\n" * 9, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    ended = [line for line in done.stderr.splitlines() if line.startswith("ended ")]
    assert ended == [f"ended 0 {words}" for words in commands], done.stderr
    assert "skipped" in done.stdout.splitlines()[-3]
