"""A solver is compiled once; whoever asks questions afterwards loads no SymPy."""

from __future__ import annotations

import importlib.util
import os
import py_compile
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest
from flint import fmpq

from quizgen.bank import solvers
from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.solvers import _is_pure, load_chain
from quizgen.core import cache
from quizgen.core.errors import BankError
from quizgen.maths.notation.printer import format_tree

UNCHECKED = py_compile.PycInvalidationMode.UNCHECKED_HASH

SOLVER = """
from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

a, b, s = symbols("a b s")
with evaluate(False):
    MODEL = Model(given={{a: "mm", b: "mm"}}, steps=(Step(s, {formula}, "mm"),))
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "solvers").mkdir()
    return tmp_path / "solvers"


@pytest.fixture
def runs(monkeypatch, empty_cache):
    """Names of the solvers that were run."""
    names = []
    compiled = solvers._compile_solver

    def noted(folder, name):
        names.append(name)
        return compiled(folder, name)

    monkeypatch.setattr(solvers, "_compile_solver", noted)
    return names


def written(folder, name, formula="a + b"):
    (folder / f"{name}.py").write_text(SOLVER.format(formula=formula))


def formula(folder, name):
    return format_tree(load_chain(folder, name)[0].steps[0].expr)


def test_a_solver_is_run_once(folder, runs):
    written(folder, "one")
    assert [formula(folder, "one"), formula(folder, "one")] == ["a + b", "a + b"]
    assert runs == ["one"]


def test_a_changed_solver_alone_is_run_again(folder, runs):
    """Python takes bytecode of the same second and size for that of the file."""
    written(folder, "one")
    written(folder, "two", "b + a")
    before = (folder / "one.py").stat()
    assert [formula(folder, name) for name in ("one", "two")] == ["a + b", "b + a"]
    written(folder, "one", "a - b")
    os.utime(folder / "one.py", ns=(before.st_atime_ns, before.st_mtime_ns))
    assert [formula(folder, name) for name in ("one", "two")] == ["a - b", "b + a"]
    assert runs == ["one", "two", "one"]
    assert not list(folder.rglob("__pycache__"))


def cached(source, place):
    """Bytecode as Python leaves it beside a file, of another source."""
    other = place.with_name(f"{place.stem}-other.py")
    other.write_text(source)
    there = Path(importlib.util.cache_from_source(place))
    there.parent.mkdir(exist_ok=True)
    py_compile.compile(other, there, invalidation_mode=UNCHECKED)
    other.unlink()


def test_bytecode_in_a_bank_is_never_run(folder, runs):
    """Whoever may write beside a file that was trusted changes nothing of what runs."""
    written(folder, "one")
    cached(SOLVER.format(formula="a - b"), folder / "one.py")
    os.utime(folder / "one.py", (0, 0))
    assert formula(folder, "one") == "a + b"


@pytest.mark.parametrize("name", ["common.pyc", f"common{EXTENSION_SUFFIXES[0]}"])
def test_what_has_no_source_is_no_module_of_a_bank(folder, runs, name):
    source = folder / "source.py"
    source.write_text("FACTOR = 2\n")
    py_compile.compile(source, folder / name)
    written(folder, "one", "FACTOR * a")
    (folder / "one.py").write_text("from .common import FACTOR\n" + (folder / "one.py").read_text())
    with pytest.raises(BankError, match="No module named"):
        load_chain(folder, "one")


def test_what_a_solver_imports_from_its_bank_counts(folder, runs):
    (folder / "common.py").write_text("FACTOR = 2\n")
    written(folder, "one", "FACTOR * a")
    source = (folder / "one.py").read_text()
    (folder / "one.py").write_text(f"from .common import FACTOR\n{source}")
    assert [formula(folder, "one"), formula(folder, "one")] == ["2*a", "2*a"]
    (folder / "common.py").write_text("FACTOR = 3\n")
    assert formula(folder, "one") == "3*a"
    assert runs == ["one", "one"]


@pytest.mark.parametrize("first", [
    "import os", "from pathlib import Path", "import json, math", "X = open",
    "import numpy as np", "X = __file__",
])  # fmt: skip
def test_what_may_follow_from_other_files_is_never_kept(folder, runs, first):
    written(folder, "one")
    source = (folder / "one.py").read_text()
    (folder / "one.py").write_text(f"{first}\n{source}")
    assert [formula(folder, "one"), formula(folder, "one")] == ["a + b", "a + b"]
    assert runs == ["one", "one"]


@pytest.mark.parametrize("data", [b"", b"\x80", b"\x81\xa5given\x80", b"\xc1", b"\x91" * 100_000])
def test_a_chain_that_cannot_be_read_is_compiled_anew(folder, runs, data, monkeypatch):
    written(folder, "one")
    monkeypatch.setattr(cache, "read_cached", lambda *_place: data)
    assert formula(folder, "one") == "a + b"
    assert runs == ["one"]


def test_a_solver_that_fails_is_told_each_time(folder, runs):
    (folder / "bad.py").write_text("x = 1\nMODEL = nothing\n")
    for _ in range(2):
        with pytest.raises(BankError, match=r"bad\.py:2: NameError"):
            load_chain(folder, "bad")
    assert runs == ["bad", "bad"]


def test_a_bank_that_is_not_trusted_runs_and_reads_no_solver_of_its_own(folder, runs):
    written(folder, "one")
    (folder.parent / "templates").mkdir()
    assert format_tree(Bank(folder.parent, trusted=True).chain("one")[0].steps[0].expr) == "a + b"
    with pytest.raises(BankError, match="--trust"):
        Bank(folder.parent).chain("one")


def test_every_chain_comes_back_as_its_model_has_it():
    """Traps, units, formulas of the sheet, and whether a number was typed as a decimal."""
    bank = builtin_bank()
    for name in dict.fromkeys(bank.rules(name).solver for name in bank.template_paths):
        if name:
            chain, _ = load_chain(bank.root / "solvers", name)
            again = Bank(bank.root, trusted=True).solver(name).MODEL.chain()
            assert (chain, repr(chain)) == (again, repr(again)), name


def test_all_solvers_of_the_bank_can_be_kept():
    for file in (builtin_bank().root / "solvers").rglob("*.py"):
        assert _is_pure(file.read_bytes()), file


def test_functions_of_whole_numbers_wait_for_the_drawn_ones(folder):
    (folder / "numbers.py").write_text('''"""Words in front."""
from __future__ import annotations

import sympy
from sympy import evaluate, gcd, isprime, lcm, symbols

from quizgen.maths.model import Model, Step

a, b, x, g, m, p, n = symbols("a b x g m p n")
with evaluate(False):
    MODEL = Model(
        given={a: "", b: ""},
        free=("x",),
        steps=(
            Step(g, gcd(a, b)), Step(m, lcm(a, b)), Step(p, isprime(a)), Step(n, sympy.nextprime(b)),
            Step("h", gcd(x**2 - 1, x**2 - x)),
        ),
    )
''')
    chain, _ = load_chain(folder, "numbers")
    solved = chain.solve({"a": fmpq(12), "b": fmpq(18)})
    assert [solved[name] for name in "gmpn"] == [6, 36, 0, 19]
    assert format_tree(chain.bind_form(chain.form_by_name["h"].expr, solved)) == "x - 1"
