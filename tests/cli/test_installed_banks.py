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
