"""Change one place of the code at a time, and see whether a test notices.

Run: ``nice uv run --isolated --python 3.13 python tools/mutate.py --out mutants.tsv`` (about half an
hour for 300). ``--only FILE:LINE`` tries the mutants of one line again. It works in a copy of what is
committed. Each mutant meets the tests that run its line, those of like name first, until one fails.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import io
import os
import pickle
import random
import shutil
import signal
import subprocess
import sys
import tarfile
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from difflib import SequenceMatcher
from pathlib import Path
from typing import NamedTuple

ROOMS = ("grading", "kinds", "bank", "paper", "classes", "web")
TESTS = (*ROOMS, "question", "practice", "hostile", "lint")
HEAVY = ("numpy", "sympy", "matplotlib.figure", "sqlalchemy.orm")
OPTIONS = ("-n", "0", "-p", "no:cacheprovider")
BROKEN = 1e9
"""Seconds of a test that fails without a mutant."""
NEAREST, SECONDS = 20, 40.0
"""Tests that a mutant meets at least, and how long it may meet others after them."""
SWAPS: dict[type, type] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Mod: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Pow: ast.Mult, ast.And: ast.Or, ast.Or: ast.And,
    ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip


class Mutant(NamedTuple):
    """One change: the lines that run it, and the text of a place before and after."""

    file: str
    lines: tuple[int, int]
    start: int
    end: int
    old: str
    new: str


def _change(node: ast.AST) -> ast.AST | str | None:
    """Return another node, or text, in place of a node; None if it stays."""
    match node:
        case ast.Compare(left, [op], [right]) if type(op) in SWAPS:
            return ast.Compare(left, [SWAPS[type(op)]()], [right])
        case ast.BinOp(left, op, right) if type(op) in SWAPS:
            return ast.BinOp(left, SWAPS[type(op)](), right)
        case ast.BoolOp(op, values):
            return ast.BoolOp(SWAPS[type(op)](), values)
        case ast.UnaryOp(ast.Not(), operand):
            return operand
        case ast.Constant(bool() as value):
            return ast.Constant(not value)
        case ast.Constant(int() | float() as value):
            return ast.Constant(value + 1)
        case ast.IfExp(test, body, orelse):
            return ast.IfExp(test, orelse, body)
        case ast.Return(ast.expr()) | ast.Raise():
            return "return None"
        case ast.Expr(ast.Call()) | ast.Continue():
            return "pass"
    return None


def iter_mutants(path: Path, name: str) -> Iterator[Mutant]:
    """Yield the mutants of a module, inside functions alone."""
    text = path.read_text("utf-8")
    starts = [0]
    for line in text.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    for function in ast.walk(ast.parse(text)):
        if isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef):
            for statement in (s for part in function.body for s in ast.walk(part)):
                if isinstance(statement, ast.stmt):
                    yield from _iter_changes(statement, name, text.encode(), starts)


def _iter_changes(
    statement: ast.stmt, name: str, text: bytes, starts: list[int]
) -> Iterator[Mutant]:
    """Yield the mutants of a statement and of what it computes itself."""
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return
    own = [n for n in ast.iter_child_nodes(statement) if isinstance(n, ast.expr)]
    if isinstance(statement, ast.AnnAssign):
        own = [statement.value] if statement.value else []
    for node in [statement, *(n for part in own for n in ast.walk(part))]:
        made = _change(node)
        if made is None or not isinstance(node, ast.stmt | ast.expr):
            continue
        new = made if isinstance(made, str) else f"({ast.unparse(made)})"
        start = starts[node.lineno - 1] + node.col_offset
        end = starts[(node.end_lineno or node.lineno) - 1] + (node.end_col_offset or 0)
        lines = statement.lineno, node.lineno
        yield Mutant(name, lines, start, end, text[start:end].decode(), new)


class Watcher:
    """A pytest plugin: which tests run a line of a mutant, and how long each takes."""

    def __init__(self, wanted: set[tuple[str, int]]) -> None:
        self.tests: dict[tuple[str, int], dict[str, None]] = defaultdict(dict)
        self.seconds: dict[str, float] = defaultdict(float)
        self._now, self._wanted = "", wanted

    def see(self, code: object, line: int) -> object:
        """Note a line that runs; one without a mutant is not heard of again."""
        place = (str(getattr(code, "co_filename", "")), line)
        if place not in self._wanted:
            return sys.monitoring.DISABLE
        if self._now:
            self.tests[place][self._now] = None
        return None

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Remember which test begins."""
        self._now = nodeid

    def pytest_runtest_logreport(self, report: object) -> None:
        """Remember how long it took; one that fails without a mutant finds none."""
        name, failed = report.nodeid, report.failed  # type: ignore[attr-defined]
        self.seconds[name] += BROKEN if failed else report.duration  # type: ignore[attr-defined]


def watch_tests(folder: Path, mutants: list[Mutant], found: Path) -> int:
    """Run the tests once, and keep in a file which run what."""
    import pytest

    watcher = Watcher({(str(folder / m.file), line) for m in mutants for line in m.lines})
    tool = sys.monitoring
    tool.use_tool_id(tool.COVERAGE_ID, "mutate")
    tool.register_callback(tool.COVERAGE_ID, tool.events.LINE, watcher.see)
    tool.set_events(tool.COVERAGE_ID, tool.events.LINE)
    pytest.main([*OPTIONS, *(f"tests/{room}" for room in TESTS)], [watcher])
    found.write_bytes(pickle.dumps((dict(watcher.tests), dict(watcher.seconds))))
    return 0


def run_child(work: Callable[[], int], seconds: float, log: str = os.devnull) -> int:
    """Return what some work gives in a process forked off, or -1 if it does not end in time."""
    child = os.fork()
    if not child:
        os.setsid()
        sink = os.open(log, os.O_RDWR | os.O_CREAT | os.O_TRUNC)
        for stream in (0, 1, 2):
            os.dup2(sink, stream)
        try:
            os._exit(work())
        finally:  # never goes on as its parent
            os._exit(70)
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return -1


def choose_tests(mutant: Mutant, tests: set[str], seconds: dict[str, float]) -> list[str]:
    """Return the tests that a mutant meets, those of its room and of like name first."""
    room, stem = Path(mutant.file).parts[1], Path(mutant.file).stem

    def nearness(test: str) -> tuple[float, float]:
        path = Path(test.partition("::")[0])
        like = SequenceMatcher(None, stem, path.stem.removeprefix("test_")).ratio()
        return -like - (path.parts[1] == room), seconds[test]

    chosen: list[str] = []
    for test in sorted((t for t in tests if seconds[t] < BROKEN), key=nearness):
        if len(chosen) < NEAREST or sum(seconds[t] for t in chosen) + seconds[test] < SECONDS:
            chosen.append(test)
    return chosen


def try_mutant(folder: Path, mutant: Mutant, tests: list[str], now: int) -> str:
    """Return ``killed``, ``slow`` (killed, too) or ``SURVIVED``."""
    path = folder / mutant.file
    before = path.read_bytes()
    path.write_bytes(before[: mutant.start] + mutant.new.encode() + before[mutant.end :])
    os.utime(path, (now, now))  # what is compiled of another mutant is older

    def work() -> int:
        import pytest

        return pytest.main([*OPTIONS, "-x", *tests])

    code = run_child(work, 120) if tests else 0
    path.write_bytes(before)
    os.utime(path, (now + 1, now + 1))
    return "SURVIVED" if code == 0 else "slow" if code == -1 else "killed"


def main() -> int:
    """Make mutants, map the tests to them, try each; print those that survive."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--each", type=int, default=50, help="mutants of each room")
    parser.add_argument("--seed", type=int, default=2029)
    parser.add_argument("--only", help="mutants of one line instead: FILE:LINE")
    parser.add_argument(
        "--out", type=Path, default=Path("mutants.tsv"), help="where they are listed"
    )
    args = parser.parse_args()
    folder, out = Path(tempfile.mkdtemp(prefix="mutate-")), args.out.resolve()
    archive = subprocess.run(["git", "archive", "HEAD"], capture_output=True, check=True).stdout
    tarfile.open(fileobj=io.BytesIO(archive)).extractall(folder, filter="data")
    os.chdir(folder)
    os.environ |= {"PYTHONPATH": str(folder), "XDG_CACHE_HOME": str(folder / ".cache")}
    sys.path.insert(0, str(folder))
    for name in HEAVY:
        importlib.import_module(name)
    mutants: list[Mutant] = []
    for room in ROOMS:
        files = sorted(Path("quizgen", room).rglob("*.py"))
        every = sorted({m for path in files for m in iter_mutants(path, str(path))})
        if args.only:
            mutants += [m for m in every if f"{m.file}:{m.lines[1]}" == args.only]
        else:
            mutants += random.Random(f"{args.seed}{room}").sample(every, args.each)  # noqa: S311
    found = folder / "tests.pickle"
    run_child(lambda: watch_tests(folder, mutants, found), 7200, f"{out}.log")
    ran, seconds = pickle.loads(found.read_bytes())  # noqa: S301 - written just now
    results: Counter[str] = Counter()
    with out.open("w", encoding="utf-8", buffering=1) as table:
        for number, mutant in enumerate(mutants):
            tests = {t for n in mutant.lines for t in ran.get((str(folder / mutant.file), n), ())}
            chosen = choose_tests(mutant, tests, seconds)
            result = try_mutant(folder, mutant, chosen, int(time.time()) + 10 * number)
            results[result] += 1
            place = f"{mutant.file}:{mutant.lines[1]}"
            print(
                result, place, mutant.old, mutant.new, len(chosen), len(tests), sep="\t", file=table
            )
    shutil.rmtree(folder)
    print(dict(results))
    return 0


if __name__ == "__main__":
    sys.exit(main())
