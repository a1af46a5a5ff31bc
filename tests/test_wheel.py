"""A wheel in an empty environment makes the same paper as the checkout."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
TABLE = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PINS = TABLE["tool"]["uv"]["constraint-dependencies"]
ARGUMENTS = ["exam", "--seed", "3", "--blueprint", "trial", "--lang", "both", "--out", "paper"]


@pytest.fixture(scope="module")
def uv():
    path = shutil.which("uv")
    if path is None:
        if os.environ.get("CI"):
            pytest.fail("uv is not installed")
        pytest.skip("uv is not installed")
    return path


@pytest.fixture(scope="module")
def built(uv, tmp_path_factory):
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run([uv, "build", "--quiet", "--out-dir", str(folder)], check=True, cwd=ROOT)
    return folder


@pytest.mark.slow
def test_wheel_and_sdist_hold_the_bank(built):
    wheel = next(built.glob("*.whl"))
    names = zipfile.ZipFile(wheel).namelist()
    assert "quizgen/builtin/templates/projection/point-to-image-plane/template.toml" in names
    assert "quizgen/builtin/solvers/projection/perspective.py" in names
    assert "quizgen/render/webfonts/stix-two-math.woff2" in names
    assert [n for n in names if n.endswith("/licenses/quizgen/render/webfonts/OFL.txt")]
    assert not [n for n in names if n.startswith(("templates/", "solvers/", "tests/"))]
    assert not [n for n in names if n.endswith(".pyc")]
    assert next(built.glob("*.tar.gz")).stat().st_size > 0


ALL = """
import sys
from quizgen.bank import bank
print(len(list(bank.builtin_bank())), bank.__file__, *sys.modules)
"""


@pytest.mark.slow
def test_a_wheel_brings_what_its_bank_comes_to(built, tmp_path):
    """Where nothing can be kept: solvers were run, and prose was read, when it was built."""
    zipfile.ZipFile(next(built.glob("*.whl"))).extractall(tmp_path)
    around = os.environ | {"PYTHONPATH": str(tmp_path), "XDG_CACHE_HOME": "/dev/null/nowhere"}
    done = subprocess.run([sys.executable, "-c", ALL], check=True, capture_output=True, text=True,
                          cwd=tmp_path, env=around)  # fmt: skip
    count, file, *loaded = done.stdout.split()
    assert int(count) == len(list((ROOT / "templates").rglob("template.toml")))
    assert Path(file).is_relative_to(tmp_path)
    assert not {"sympy", "markdown_it"} & set(loaded)


def test_what_decides_the_bytes_of_a_pdf_is_fixed_for_who_installs_it():
    fixed = {needed for needed in TABLE["project"]["dependencies"] if "==" in needed}
    names = {needed.partition("==")[0] for needed in fixed}
    assert names == {"matplotlib", "typst", "fontpkg-hind-siliguri"}
    assert fixed <= set(PINS)


@pytest.mark.slow
def test_a_wheel_in_an_empty_environment_makes_the_same_paper(uv, built, tmp_path):
    """Beside the newest of all that it needs: who installs it has none of our versions."""
    environment = tmp_path / "venv"
    subprocess.run(
        [uv, "venv", "--quiet", "--python", sys.executable, str(environment)], check=True
    )
    python = next(p for p in (environment / "bin" / "python", environment / "Scripts" / "python.exe")
                  if p.exists())  # fmt: skip
    subprocess.run([uv, "pip", "install", "--quiet", "--python", str(python),
                    str(next(built.glob("*.whl")))], check=True, cwd=tmp_path)  # fmt: skip
    for folder, command in (
        ("wheel", [str(python), "-m", "quizgen"]),
        ("checkout", [sys.executable, "-m", "quizgen"]),
    ):
        (tmp_path / folder).mkdir()
        subprocess.run([*command, *ARGUMENTS], check=True, cwd=tmp_path / folder,
                       capture_output=True)  # fmt: skip
    made = {
        folder: {p.name: p.read_bytes() for p in (tmp_path / folder / "paper").iterdir()}
        for folder in ("wheel", "checkout")
    }
    assert made["wheel"].keys() == made["checkout"].keys()
    for name, data in made["wheel"].items():
        assert data == made["checkout"][name], name
    for extra, command in (("web", "serve"), ("class", "class code . x")):
        done = subprocess.run([str(python), "-m", "quizgen", *command.split()],
                              capture_output=True, text=True, cwd=tmp_path, check=False)  # fmt: skip
        assert f'type: pip install "quizgen[{extra}]"' in done.stderr


def test_a_wheel_is_built_with_what_a_checkout_runs_with():
    """What is kept under another version of SymPy is not found."""
    hook = TABLE["tool"]["hatch"]["build"]["targets"]["wheel"]["hooks"]["custom"]
    assert set(hook["dependencies"]) <= set(PINS)
