"""Banks that packages bring, really built and installed: listed, mixed, trusted one by one."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "bank"))

from mechanics import FILES, write

PROJECT = """
[build-system]
requires = ["hatchling"]
build-backend = "hatchling.build"
[project]
name = "bank-of-{0}"
version = "{1}"
[project.entry-points."quizgen.banks"]
{0} = "bank_of_{0}"
"""

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def install(tmp_path_factory):
    """Builds a wheel of a bank and installs it beside those before; where Python finds them."""
    uv = shutil.which("uv")
    if uv is None:
        if os.environ.get("CI"):
            pytest.fail("uv is not installed")
        pytest.skip("uv is not installed")
    site = tmp_path_factory.mktemp("site")

    def installed(name: str, version: str) -> Path:
        folder = tmp_path_factory.mktemp(name)
        about = FILES["templates/bank.toml"].replace('"mechanics"', f'"{name}"')
        about = about.replace('"1.2"', f'"{version}"')
        root = write(folder / f"bank_of_{name}", {"templates/bank.toml": about})
        (root / "__init__.py").touch()
        (folder / "pyproject.toml").write_text(PROJECT.format(name, version), "utf-8")
        subprocess.run([uv, "build", "--quiet", "--wheel"], check=True, cwd=folder)
        (wheel,) = (folder / "dist").glob("*.whl")
        subprocess.run([uv, "pip", "install", "--quiet", "--target", str(site), "--upgrade",
                        str(wheel)], check=True)  # fmt: skip
        return site

    return installed


@pytest.fixture
def quizgen(install, tmp_path):
    def run(*words: str) -> subprocess.CompletedProcess[str]:
        around = os.environ | {"PYTHONPATH": str(site), "XDG_DATA_HOME": str(tmp_path / "home")}
        return subprocess.run([sys.executable, "-m", "quizgen", *words], cwd=tmp_path, env=around,
                              capture_output=True, text=True, check=False)  # fmt: skip

    install("statics", "1.0")
    site = install("dynamics", "2.0")
    return run


BOTH = ("--bank", "statics", "--bank", "dynamics")
PAPER = ("exam", *BOTH, "--topic", "forces", "--seed", "1", "--format", "html", "--out", "paper")


def test_two_installed_banks_make_a_paper_together(quizgen, install, tmp_path):
    rows = [line.split()[:2] for line in quizgen("banks").stdout.splitlines()[1:]]
    assert {tuple(row) for row in rows} > {("statics", "1.0"), ("dynamics", "2.0")}

    refused = quizgen(*PAPER, "--trust-bank", "statics")
    assert refused.returncode == 2
    assert "bank_of_dynamics" in refused.stderr
    assert "--trust" in refused.stderr

    made = quizgen(*PAPER, "--trust")
    assert made.returncode == 0, made.stderr
    key = json.loads((tmp_path / "paper" / "key.json").read_text("utf-8"))
    asked = {question["template"] for question in key["questions"]}
    assert asked == {"statics:push", "dynamics:push"}, "both call it push"
    assert {(one["name"], one["version"]) for one in key["banks"]} == {
        ("statics", "1.0"), ("dynamics", "2.0"),
    }  # fmt: skip

    check = ("check", "paper/key.json", "paper/answers.toml")
    assert quizgen(*check, *BOTH).stderr == ""
    install("dynamics", "2.1")
    told = quizgen(*check, *BOTH).stderr
    assert told == "quizgen: dynamics: version 2.1 here, 2.0 on the paper; marked by the key\n"


def test_a_package_begins_sound_and_is_used_by_its_name(tmp_path):
    """As its own CI does: build it, install it, prove it, print a paper."""
    uv = shutil.which("uv")
    if uv is None:
        pytest.skip("uv is not installed")
    site = tmp_path / "site"
    around = os.environ | {"PYTHONPATH": str(site), "XDG_DATA_HOME": str(tmp_path / "home")}

    def run(*words: str | Path) -> str:
        return subprocess.run([*map(str, words)], check=True, cwd=tmp_path, env=around, text=True,
                              stdout=subprocess.PIPE).stdout  # fmt: skip

    quizgen = (sys.executable, "-m", "quizgen")
    run(*quizgen, "new", "bank", "Heat-1", "--package", "--lang", "en", "--lang", "de")
    project = tmp_path / "Heat-1"
    workflow = (project / ".github/workflows/lint.yml").read_text("utf-8")
    steps = [
        line.partition("run: ")[2].split() for line in workflow.splitlines() if "run: " in line
    ]
    assert [step[:2] for step in steps] == [
        ["pip", "install"], ["quizgen", "lint"], ["quizgen", "exam"],
    ]  # fmt: skip
    run(uv, "build", "--quiet", "--wheel", project)
    (wheel,) = (project / "dist").glob("bank_of_heat_1-0.1-*.whl")
    run(uv, "pip", "install", "--quiet", "--no-deps", "--target", site, wheel)
    shutil.rmtree(project)
    for _, *words in steps[1:]:
        run(*quizgen, *words)
    (listed,) = [line for line in run(*quizgen, "banks").splitlines() if "Heat-1" in line]
    assert str(site / "bank_of_heat_1") in listed
    (paper,) = (tmp_path / "exam").glob("*/key.json")
    assert json.loads(paper.read_text("utf-8"))["banks"][0]["name"] == "Heat-1"
