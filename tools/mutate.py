"""Change one place of the code at a time, and see whether a test notices.

Run: ``nice uv run python tools/mutate.py`` (half an hour of CPU for 300). In a copy of what is
committed, each place gets a switch between the text and its mutant; the tests run once, which says
who meets which switch; then each mutant meets those tests in a process of its own, the quickest
first, until one fails. ``mutants.tsv`` lists all: ``killed``, ``hung`` or ``SURVIVED``.
"""

from __future__ import annotations

import argparse
import ast
import gc
import importlib
import io
import os
import pickle
import pkgutil
import random
import shutil
import signal
import subprocess
import sys
import tarfile
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

ROOMS = ("grading", "kinds", "bank", "paper", "classes", "web")
FEWEST, MOST, SECONDS, PATIENCE = 20, 200, 40.0, 150.0
"""Tests that a mutant meets at least and at most, how long beyond the fewest, when it hangs."""
CACHED = type(cache(int))
SWAPS: dict[type, type] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Mod: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Pow: ast.Mult, ast.And: ast.Or, ast.Or: ast.And,
    ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip
SWITCH = """import os
HITS, active = set(), int(os.environ.get("MUTANT", "-1"))
def on(number):
    HITS.add(number)
    return number == active
"""
"""What the copy imports: processes that a test starts know the mutant, too."""
ON = "__import__('mutant_switch').on({number})"


class Mutant(NamedTuple):
    """One change: a place in bytes of a file, and the text before and after."""

    file: str
    line: int
    start: int
    end: int
    old: str
    new: str

    def switch(self, number: int) -> str:
        """Return the text that stands for both."""
        on = ON.format(number=number)
        if self.new == "pass":
            return f"if not {on}: {self.old}"
        return f"({self.new} if {on} else ({self.old}))"


def _swap(node: ast.AST) -> ast.expr | None:
    """Return another expression in place of one; None if it stays."""
    match node:
        case ast.Compare(left, [op], [right]) if type(op) in SWAPS:
            return ast.Compare(left, [SWAPS[type(op)]()], [right])
        case ast.BinOp(left, op, right) if type(op) in SWAPS:
            return ast.BinOp(left, SWAPS[type(op)](), right)
        case ast.BoolOp(op, values):
            return ast.BoolOp(SWAPS[type(op)](), values)
        case ast.UnaryOp(ast.Not(), operand):
            return operand
        case ast.Constant(int() | float() as value):
            return ast.Constant(not value if isinstance(value, bool) else value + 1)
    return ast.IfExp(node.test, node.orelse, node.body) if isinstance(node, ast.IfExp) else None


def _walk(node: ast.AST) -> Iterator[ast.AST]:
    """Yield what is computed where it stands: no types, no patterns, no parts of f-strings."""
    yield node
    for name, value in ast.iter_fields(node):
        for child in value if isinstance(value, list) else [value]:
            if (
                isinstance(child, ast.AST)
                and name not in {"annotation", "pattern", "decorator_list", "returns"}
                and not isinstance(child, ast.JoinedStr | ast.arguments)
            ):
                yield from _walk(child)


def iter_mutants(path: Path) -> Iterator[Mutant]:
    """Yield the mutants of a module, inside functions alone."""
    text = path.read_bytes()
    lines = text.splitlines(keepends=True)
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line))

    def make(node: Any, new: str) -> Mutant:
        start = starts[node.lineno - 1] + node.col_offset
        end = starts[node.end_lineno - 1] + node.end_col_offset
        return Mutant(str(path), node.lineno, start, end, text[start:end].decode(), new)

    functions = (f for f in ast.walk(ast.parse(text)) if isinstance(f, ast.FunctionDef))
    for node in {n: 0 for f in functions for part in f.body for n in _walk(part)}:
        other = _swap(node)
        if other is not None:
            yield make(node, f"({ast.unparse(other)})")
        elif isinstance(node, ast.Return) and node.value and not isinstance(node.value, ast.Name):
            yield make(node.value, "None")
        elif isinstance(node, ast.Raise | ast.Continue | ast.Expr):
            words = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
            if not words and not lines[node.lineno - 1][: node.col_offset].strip():
                yield make(node, "pass")


def write_switches(folder: Path, each: int, seed: int) -> list[Mutant]:
    """Choose mutants of every room, and write their switches into a copy of the code."""
    chosen: list[Mutant] = []
    for room in ROOMS:
        every = [
            m for path in sorted(Path("quizgen", room).rglob("*.py")) for m in iter_mutants(path)
        ]
        random.Random(f"{seed}{room}").shuffle(every)  # noqa: S311
        mine: list[Mutant] = []
        for one in every:
            apart = (one.file != m.file or one.end <= m.start or m.end <= one.start for m in mine)
            if len(mine) < each and all(apart):
                mine.append(one)
        chosen += mine
    for number, one in sorted(enumerate(chosen), key=lambda pair: -pair[1].start):
        path = folder / one.file
        text = path.read_bytes()
        path.write_bytes(text[: one.start] + one.switch(number).encode() + text[one.end :])
    (folder / "mutant_switch.py").write_text(SWITCH, "utf-8")
    return chosen


class Runner:
    """A pytest plugin that runs the tests for every mutant instead of once."""

    def __init__(self, mutants: list[Mutant], out: Path) -> None:
        self.mutants, self.out = mutants, out
        self.seconds: dict[str, float] = defaultdict(float)
        self.failed: set[str] = set()
        self.sound: set[Any] = set()

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Remember how long a test takes, and whether it fails."""
        self.seconds[report.nodeid] += report.duration
        if report.failed:
            self.failed.add(report.nodeid)

    def pytest_runtestloop(self, session: Any) -> bool:
        """Find who meets which mutant, then try each."""
        import mutant_switch  # type: ignore[import-not-found]

        import_all_modules()
        found = Path("tests.pickle")
        run_child(lambda: self._map(session.items, mutant_switch, found), 1e5)
        meets, seconds = pickle.loads(found.read_bytes())  # noqa: S301 - written just now
        each = len(self.mutants) // len(ROOMS)
        with self.out.open("w", encoding="utf-8", buffering=1) as table:
            for number in sorted(range(len(self.mutants)), key=lambda n: n % each):  # rooms in turn
                mutant = self.mutants[number]
                tests = [t for t in session.items if number in meets.get(t.nodeid, ())]
                near = choose_tests(tests, seconds)
                result = self._find_result(near, mutant_switch, number)
                place = f"{mutant.file}:{mutant.line}"
                row = (result, place, mutant.old, mutant.new, len(near))
                print(*(" ".join(str(one).split()) for one in row), sep="\t", file=table)
        return True

    def _find_result(self, items: list[Any], switch: Any, number: int) -> str:
        """Return how a mutant ends; a test that fails here without it, too, says nothing."""
        while True:
            code = run_child(partial(self._try, items, switch, number), PATIENCE)
            if not 0 < code <= len(items):
                return {0: "SURVIVED", -1: "hung"}.get(code, "killed")
            one = items[code - 1]
            if one in self.sound or not run_child(partial(self._try, [one], switch, -1), PATIENCE):
                self.sound.add(one)
                return "killed"
            items = [item for item in items if item is not one]

    def _map(self, items: list[Any], switch: Any, found: Path) -> int:
        """Run all tests, and keep in a file which mutants those that pass meet."""
        meets: dict[str, set[int]] = {}
        for item, following in zip(items, [*items[1:], None], strict=True):
            switch.HITS.clear()
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if item.nodeid not in self.failed:
                meets[item.nodeid] = set(switch.HITS)
        found.write_bytes(pickle.dumps((meets, dict(self.seconds))))
        return 0

    def _try(self, items: list[Any], switch: Any, number: int) -> int:
        """Run tests up to the first that fails, and return which that is, from 1; 0 if none does.

        For a mutant of the bank nothing is taken from a cache.
        """
        switch.active = number
        os.environ["MUTANT"] = str(number)
        if "/bank/" in self.mutants[number].file:
            os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(dir=".")
            for one in gc.get_objects():
                if isinstance(one, CACHED) and "quizgen" in (one.__module__ or ""):
                    one.cache_clear()
        for place, item in enumerate(items):
            following = items[place + 1] if item is not items[-1] else None
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if self.failed:
                return place + 1
        return 0


def choose_tests(items: list[Any], seconds: dict[str, float]) -> list[Any]:
    """Return the tests that a mutant meets, the quickest first, as far as there is time."""
    chosen, spent = list[Any](), 0.0
    for item in sorted(items, key=lambda one: seconds[one.nodeid]):
        spent += seconds[item.nodeid]
        if len(chosen) < FEWEST or (spent < SECONDS and len(chosen) < MOST):
            chosen.append(item)
    return chosen


def import_all_modules() -> None:
    """Import what tests import, once for all processes that are forked off."""
    import quizgen

    for found in pkgutil.walk_packages(quizgen.__path__, "quizgen."):
        if not found.name.endswith(("__main__", "_build_hook", "migrations.env")):
            importlib.import_module(found.name)


def run_child(work: Callable[[], int], seconds: float) -> int:
    """Return what some work gives in a process forked off, or -1 if it does not end in time."""
    child = os.fork()
    if not child:
        os.setsid()
        sink = os.open(os.devnull, os.O_RDWR)
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


def main() -> int:
    """Make the copy, and let pytest collect its tests once for all mutants."""
    import pytest

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--each", type=int, default=50, help="mutants of each room")
    parser.add_argument("--seed", type=int, default=2029)
    parser.add_argument("--tests", default=" ".join(f"tests/{room}" for room in ROOMS))
    parser.add_argument("--out", type=Path, default=Path("mutants.tsv"))
    args = parser.parse_args()
    folder, out = Path(tempfile.mkdtemp(prefix="mutate-")), args.out.resolve()
    archive = subprocess.run(["git", "archive", "HEAD"], capture_output=True, check=True).stdout
    with tarfile.open(fileobj=io.BytesIO(archive)) as tree:
        tree.extractall(folder, filter="data")
    os.chdir(folder)
    os.environ |= {"PYTHONPATH": str(folder), "XDG_CACHE_HOME": str(folder / ".cache")}
    sys.path.insert(0, str(folder))
    runner = Runner(write_switches(folder, args.each, args.seed), out)
    pytest.main(["-n", "0", "-s", "-p", "no:cacheprovider", *args.tests.split()], [runner])
    shutil.rmtree(folder)
    print(*(line for line in out.read_text("utf-8").splitlines() if "SURVIVED" in line), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
