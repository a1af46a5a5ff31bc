"""Which package may import which, read from the source with ast."""

from __future__ import annotations

import ast
import subprocess
import sys
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from sources import nodes

pytestmark = pytest.mark.slow  # all of the source is parsed, processes are started
ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "quizgen"

LAYERS = {
    "core": "",
    "locale": "core",
    "maths": "core",
    "numerics": "",
    "typeset": "core locale maths",
    "camera": "core maths numerics",
    "grading": "core locale maths",
    "kinds": "core locale maths typeset grading",
    "bank": "core locale maths typeset kinds",
    "figures": "core locale maths camera kinds",
    "question": "core locale maths typeset grading kinds bank figures",
    "paper": "core locale maths typeset grading kinds bank question",
    "practice": "core locale grading kinds bank question paper",
    "store": "core bank grading paper practice",
    "render": "core locale typeset figures question paper",
    "cards": "core locale typeset grading bank figures question paper render",
    "tradeoff": "core locale maths numerics bank figures render",
    "classes": "core locale maths grading kinds bank figures paper render",
    "lms": "core locale maths typeset grading kinds bank figures question paper practice render classes",
    "web": "core locale maths typeset camera grading kinds bank figures question paper "
    "practice store render cards tradeoff classes",
    "lint": "core locale maths typeset grading kinds bank figures question paper render",
    "cli": "core locale camera grading kinds bank figures question paper practice store render "
    "cards tradeoff classes lms web lint",
}
"""Package to the packages below it that it may use. Solvers use ``maths.model`` alone."""

RUNNER = PACKAGE / "grading" / "program_runner.py"
"""Runs what learners write: a process of its own that nothing imports, behind its own walls."""
MAY_IMPORT_BY_NAME = {
    "__init__.py",
    "cli/main.py",
    "bank/solvers.py",
    str(RUNNER.relative_to(PACKAGE)),
}
"""The lazy public names, the lazy commands, a bank's own solvers, and what NumPy looks up."""


def package_of(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def module_name(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


MODULES = {module_name(path): path for path in sorted(PACKAGE.rglob("*.py"))}


@cache
def imported_modules(path: Path) -> frozenset[str]:
    """Modules of quizgen that a file imports, anywhere in it."""
    found: set[str] = set()
    for node in nodes(path):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("quizgen"):
            whole = {f"{node.module}.{alias.name}" for alias in node.names} & MODULES.keys()
            found |= whole or {node.module}
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names if alias.name in MODULES}
    return frozenset(found - {module_name(path) if path.is_relative_to(PACKAGE) else ""})


def imported(path: Path) -> set[str]:
    """Packages of quizgen that a file imports."""
    modules = imported_modules(path)
    return {name.split(".")[1] for name in modules if "." in name}


FILES = [path for path in MODULES.values() if not package_of(path).startswith("_")]


def test_a_package_imports_only_packages_below_it():
    for path in FILES:
        package = package_of(path)
        assert imported(path) - {package} <= set(LAYERS[package].split()), path


def test_every_package_has_its_layer():
    assert {package_of(path) for path in FILES} <= LAYERS.keys()


PACKAGES = [path for path in MODULES.values() if path.name == "__init__.py"]


def test_a_package_says_what_comes_in_what_goes_out_and_what_it_must_never_know():
    for path in PACKAGES:
        said = " ".join((ast.get_docstring(nodes(path)[0]) or "").split())
        missing = [word for word in ("In: ", "Out: ", "Must never know: ") if word not in said]
        assert missing == [], path


def test_layers_are_listed_from_the_ground_up():
    below: set[str] = set()
    for package, uses in LAYERS.items():
        assert set(uses.split()) <= below, package
        below.add(package)


def test_no_module_imports_itself_in_a_circle():
    TopologicalSorter({name: imported_modules(path) for name, path in MODULES.items()}).prepare()


def test_nothing_is_imported_by_a_computed_name():
    for path in MODULES.values():
        names = {node.id for node in nodes(path) if isinstance(node, ast.Name)}
        attributes = {node.attr for node in nodes(path) if isinstance(node, ast.Attribute)}
        if {"import_module", "__import__"} & (names | attributes):
            assert str(path.relative_to(PACKAGE)) in MAY_IMPORT_BY_NAME, path


def test_nothing_imports_commands():
    others = [path for path in FILES if package_of(path) != "cli"]
    assert not [path for path in others if "cli" in imported(path)]


def test_solvers_know_only_the_model():
    for path in (ROOT / "solvers").rglob("*.py"):
        assert imported_modules(path) <= {"quizgen.maths.model", "quizgen.maths.lists"}, path


def test_no_text_is_ever_run():
    banned = {"eval", "exec", "sympify", "parse_expr"}
    for folder in ("quizgen", "solvers"):
        for path in {*(ROOT / folder).rglob("*.py")} - {RUNNER}:
            for node in nodes(path):
                if isinstance(node, ast.Call):
                    name = getattr(node.func, "id", getattr(node.func, "attr", ""))
                    assert name not in banned, f"{path}: {name}"


def test_what_runs_strangers_programs_is_imported_by_nothing():
    assert not imported(RUNNER)
    assert not [path for path in FILES if module_name(RUNNER) in imported_modules(path)]


def loaded(code: str) -> set[str]:
    run = subprocess.run(
        [sys.executable, "-c", f"import sys\n{code}\nprint(*sys.modules)"],
        capture_output=True, text=True, check=True, cwd=ROOT,
    )  # fmt: skip
    return set(run.stdout.split())


HELP = """
from quizgen.cli.main import main
try: main(['--help'])
except SystemExit: pass
"""


def test_help_loads_no_heavy_package():
    assert not {"numpy", "sympy", "matplotlib", "rich", "typst"} & loaded(HELP)


def test_checking_loads_neither_sympy_nor_matplotlib():
    code = "import quizgen.kinds.grade as c\nc.grade_answer({'kind':'number','value':'20/3','decimals':3},'6,67')"
    assert not {"numpy", "sympy", "matplotlib"} & loaded(code)


def test_marking_a_class_loads_what_marking_one_loads():
    assert not {"numpy", "sympy", "matplotlib", "typst"} & loaded(
        "import quizgen.classes.grading_run"
    )


def test_a_server_is_ready_without_what_only_its_workers_need(tmp_path):
    code = (
        "import quizgen.web.server\nfrom quizgen.web.app import create_app\n"
        "from quizgen.web.settings import ServerSettings\n"
        f"create_app(ServerSettings({f'sqlite:///{tmp_path}/x.sqlite3'!r}))"
    )
    assert not {"numpy", "sympy", "matplotlib", "alembic", "typst"} & loaded(code)
