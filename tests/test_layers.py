"""Which stage of the line may import which, read from the source with ast."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "quizgen"

ALLOWED = {
    "errors": set(),
    "expr": {"errors", "_exact", "_floats"},
    "_exact": {"errors"},
    "_floats": set(),
    "units": {"errors"},
    "chain": {"errors", "expr"},
    "numbers": {"errors"},
    "reader": {"errors", "expr"},
    "formula": {"errors", "expr", "units"},
    "model": {"errors", "expr", "chain", "formula"},
    "template": {"errors", "expr", "chain", "units", "reader"},
    "text": {"errors", "expr", "reader"},
    "bank": {"errors", "chain", "template", "text"},
    "traps": {"errors", "expr", "chain", "numbers", "units", "template"},
    "draw": {"errors", "expr", "chain", "numbers", "template", "traps"},
    "locale": {"errors"},
    "figures": {"errors", "camera", "bank"},
    "check": {"errors", "expr", "chain", "numbers", "units", "reader", "locale"},
    "asking": {"locale", "units"},
    "specs": {"errors", "expr", "traps", "draw", "numbers", "text", "reader", "solution"},
    "solution": {"errors", "expr", "locale", "chain", "draw", "numbers", "units", "text", "reader", "formula",
                 "specs", "check"},
    "question": {"errors", "expr", "traps", "draw", "numbers", "template", "text", "reader", "figures",
                 "asking", "specs", "solution"},
    "blueprint": {"errors", "locale"},
    "exam": {"errors", "bank", "blueprint", "draw", "question", "template", "text"},
    "camera": {"errors", "bank", "units"},
}  # fmt: skip
"""Stage to the stages it may use. Everything else (render, cards, lint, commands) may use all."""


def stage_of(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imported(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            parts = node.module.split(".")
            if parts[0] == "quizgen":
                found |= {parts[1]} if len(parts) > 1 else {alias.name for alias in node.names}
        elif isinstance(node, ast.Import):
            found |= {a.name.split(".")[1] for a in node.names if a.name.startswith("quizgen.")}
    return found


FILES = sorted(p for p in PACKAGE.rglob("*.py") if stage_of(p) in ALLOWED)


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_stage_imports_only_what_stands_before_it(path):
    stage = stage_of(path)
    assert imported(path) - {stage} <= ALLOWED[stage]


def test_nothing_imports_commands():
    others = [p for p in PACKAGE.rglob("*.py") if not stage_of(p).startswith(("cli", "__"))]
    assert not [p for p in others if any(name.startswith("cli") for name in imported(p))]


def test_solvers_know_only_the_model():
    for path in (ROOT / "solvers").glob("*.py"):
        assert imported(path) <= {"model"}, path


def test_no_text_is_ever_run():
    banned = {"eval", "exec", "sympify", "parse_expr"}
    for folder in ("quizgen", "solvers"):
        for path in (ROOT / folder).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Call):
                    name = getattr(node.func, "id", getattr(node.func, "attr", ""))
                    assert name not in banned, f"{path}: {name}"


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
    code = "import quizgen.marking.mark as c\nc.mark({'kind':'number','value':'20/3','decimals':3},'6,67')"
    assert not {"numpy", "sympy", "matplotlib"} & loaded(code)


def test_help_is_quick():
    code = f"import time{HELP}\nprint('cpu', time.process_time())"
    times = []
    for _ in range(3):
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                             check=True, cwd=ROOT)  # fmt: skip
        times.append(float(run.stdout.split("cpu ")[1].split()[0]))
    assert min(times) < 0.15
