"""Change one place of the code at a time, and see whether a test notices.

Run: ``nice uv run python tools/mutate.py`` (20 minutes of CPU for 300). In a copy of what is
committed, each place gets a switch between the text and its mutant; every file of tests runs once,
which says who meets which switch; then each mutant meets those tests in a process of its own, the
quickest first, until one fails that passes without it. ``mutants.tsv`` lists all: ``killed``,
``hung`` or ``SURVIVED``; ``--again mutants.tsv`` tries only the last once more.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import gc
import importlib
import io
import itertools
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
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

ROOMS = ("grading", "kinds", "bank", "paper", "classes", "web")
SECONDS, PATIENCE = 8.0, 900.0
"""Of CPU, how much in tests one mutant meets; of a clock, after how much it hangs."""
SWAPS: dict[type, type] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Mod: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Pow: ast.Mult, ast.And: ast.Or, ast.Or: ast.And,
    ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip
SWITCH = """import contextlib, os
SEEN, HITS, active = set(), os.environ.get("MUTANT_HITS"), int(os.environ.get("MUTANT", "-1"))
def on(number):
    if HITS and number not in SEEN:
        SEEN.add(number)
        with contextlib.suppress(OSError):
            open(f"{HITS}/{number}", "w").close()
    return number == active
"""
"""What the copy imports: processes that a test starts know the mutant and tell that they met it."""
ON = "__import__('mutant_switch').on({number})"


class Mutant(NamedTuple):
    """One change: a place in bytes of a file, and the text before and after."""

    file: str
    line: int
    start: int
    end: int
    old: str
    new: str

    @property
    def row(self) -> tuple[str, str, str]:
        """The file and both texts on one line each, as a table has them."""
        return self.file, " ".join(self.old.split()), " ".join(self.new.split())

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

    kinds = ast.FunctionDef | ast.AsyncFunctionDef
    functions = (f for f in ast.walk(ast.parse(text)) if isinstance(f, kinds))
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


def write_switches(folder: Path, each: int, seed: int) -> dict[int, Mutant]:
    """Choose mutants of every room, and write their switches into a copy of the code."""
    chosen: dict[int, Mutant] = {}
    for start, room in enumerate(ROOMS):  # rooms take turns: a run can be cut short
        files = sorted(Path("quizgen", room).rglob("*.py"))
        every = [one for path in files for one in iter_mutants(path)]
        random.Random(f"{seed}{room}").shuffle(every)  # noqa: S311
        mine: list[Mutant] = []
        for one in every:
            apart = (one.file != m.file or one.end <= m.start or m.end <= one.start for m in mine)
            if len(mine) < each and one.new != one.old and all(apart):
                mine.append(one)
        chosen |= {start + len(ROOMS) * turn: one for turn, one in enumerate(mine)}
    for number, one in sorted(chosen.items(), key=lambda pair: -pair[1].start):
        path = folder / one.file
        text = path.read_bytes()
        path.write_bytes(text[: one.start] + one.switch(number).encode() + text[one.end :])
    (folder / "mutant_switch.py").write_text(SWITCH, "utf-8")
    return dict(sorted(chosen.items()))


class Runner:
    """A pytest plugin that runs the tests for every mutant instead of once."""

    def __init__(self, mutants: dict[int, Mutant], out: Path, key: object) -> None:
        self.mutants, self.out, self.key, self.failed = mutants, out, key, False
        self.meets: dict[str, set[int]] = {}
        self.seconds: dict[str, float] = {}

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Remember whether a test fails."""
        self.failed |= report.failed

    def pytest_runtestloop(self, session: Any) -> bool:
        """Find who meets which mutant, then try each; go on where a run of the same was cut off."""
        forget_all()
        kept, found = self.out.with_suffix(".pickle"), Path("found.pickle")
        files: dict[str, tuple[dict[str, set[int]], dict[str, float]]] = {}
        if kept.exists():
            key, files = pickle.loads(kept.read_bytes())  # noqa: S301 - this tool's own
            files = files if key == self.key else {}
        if not files:
            self.out.unlink(missing_ok=True)
        for path, items in itertools.groupby(session.items, key=lambda one: one.path.name):
            if path not in files:
                found.write_bytes(pickle.dumps(({}, {})))
                run_child(partial(self._map, [*items], found))
                files[path] = pickle.loads(found.read_bytes())  # noqa: S301
                kept.write_bytes(pickle.dumps((self.key, files)))
            self.meets |= files[path][0]
            self.seconds |= files[path][1]
        with self.out.open("a+", encoding="utf-8", buffering=1) as table:
            table.seek(0)
            done = {tuple(line.split("\t")[1:4]) for line in table}
            for number, mutant in self.mutants.items():
                all_met = [t for t in session.items if number in self.meets.get(t.nodeid, ())]
                near = self._choose(all_met)
                if mutant.row not in done:
                    result, killer = self._find_result(near, number)
                    met = f"{len(near)} of {len(all_met)}"
                    print(result, *mutant.row, mutant.line, met, killer, sep="\t", file=table)
        return True

    def _choose(self, items: list[Any]) -> list[Any]:
        """Return the quickest tests, as far as there is time."""
        items = sorted(items, key=lambda one: self.seconds[one.nodeid])
        spent = itertools.accumulate(self.seconds[one.nodeid] for one in items)
        chosen = [one for one, until in zip(items, spent, strict=True) if until < SECONDS]
        return chosen or items[:1]

    def _map(self, items: list[Any], found: Path) -> int:
        """Run the tests of a file; keep which mutants those that pass meet, and their CPU time."""
        meets, seconds = dict[str, set[int]](), dict[str, float]()
        import mutant_switch  # type: ignore[import-not-found]

        hits = Path(mutant_switch.HITS)
        for item, following in zip(items, [*items[1:], None], strict=True):
            before, self.failed = sum(os.times()[:4]), False
            mutant_switch.SEEN.clear()
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            met = {int(one.name) for one in hits.iterdir()}
            for number in met:
                (hits / str(number)).unlink()
            if not self.failed:
                meets[item.nodeid] = met
                seconds[item.nodeid] = sum(os.times()[:4]) - before
        found.write_bytes(pickle.dumps((meets, seconds)))
        return 0

    def _find_result(self, items: list[Any], number: int) -> tuple[str, str]:
        """Return how a mutant ends, and by which test; one that fails without it says nothing."""
        while True:
            place = Path("place")
            place.write_text("0")
            code = run_child(partial(self._try, items, number, place))
            at = int(place.read_text())
            if not code:
                return "SURVIVED", ""
            if code in {-signal.SIGPROF, -signal.SIGKILL}:
                return "hung", items[at].nodeid
            if not run_child(partial(self._try, items[: at + 1], -1, place)):
                return "killed", items[at].nodeid
            items = [*items[:at], *items[at + 1 :]]

    def _try(self, items: list[Any], number: int, place: Path) -> int:
        """Run tests up to the first that fails; write down at which this is.

        What bank and papers keep on disk would hide their mutants, and outlive them.
        """
        import mutant_switch

        mutant_switch.HITS, mutant_switch.active = None, number
        os.environ |= {"MUTANT": str(number), "MUTANT_HITS": ""}
        if number >= 0 and Path(self.mutants[number].file).parts[1] in {"bank", "paper"}:
            os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(dir=".")
        self.failed = False
        for at, item in enumerate(items):
            place.write_text(str(at))
            signal.setitimer(signal.ITIMER_PROF, 20 + 10 * self.seconds[item.nodeid])
            following = items[at + 1] if item is not items[-1] else None
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if self.failed:
                return 1
        return 0


def forget_all() -> None:
    """Import what tests import, once for all processes forked off; forget what collecting found."""
    import quizgen

    for found in pkgutil.walk_packages(quizgen.__path__, "quizgen."):
        if not found.name.endswith(("__main__", "_build_hook", "migrations.env")):
            importlib.import_module(found.name)
    gc.unfreeze()
    for one in gc.get_objects():
        if isinstance(one, type(cache(int))) and "quizgen" in (one.__module__ or ""):
            one.cache_clear()


def run_child(work: Callable[[], int]) -> int:
    """Return how a process forked off for some work ends: minus the signal that killed it, too."""
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
    until, ended, status = time.monotonic() + PATIENCE, 0, 0
    while not ended and time.monotonic() < until:
        time.sleep(0.02)
        ended, status = os.waitpid(child, os.WNOHANG)
    with contextlib.suppress(ProcessLookupError):  # what it started, too
        os.killpg(child, signal.SIGKILL)
    return os.waitstatus_to_exitcode(status if ended else os.waitpid(child, 0)[1])


def main() -> int:
    """Make the copy, and let pytest collect its tests once for all mutants."""
    import pytest

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--each", type=int, default=50, help="mutants of each room")
    parser.add_argument("--seed", type=int, default=2029)
    parser.add_argument("--tests", default=" ".join(f"tests/{room}" for room in ROOMS))
    parser.add_argument("--again", type=Path, help="a table: only mutants that survived in it")
    parser.add_argument("--out", type=Path, default=Path("mutants.tsv"))
    args = parser.parse_args()
    folder, out = Path(tempfile.mkdtemp(prefix="mutate-")), args.out.resolve()
    table = args.again.read_text("utf-8") if args.again else ""
    again = {tuple(line.split("\t")[:4]) for line in table.splitlines()}
    commit = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, check=True).stdout
    archive = subprocess.run(["git", "archive", "HEAD"], capture_output=True, check=True).stdout
    with tarfile.open(fileobj=io.BytesIO(archive)) as tree:
        tree.extractall(folder, filter="data")
    os.chdir(folder)
    (folder / "hits").mkdir()
    os.environ |= {"PYTHONPATH": str(folder), "XDG_CACHE_HOME": str(folder / ".cache")}
    os.environ |= {"MUTANT_HITS": str(folder / "hits"), "OPENBLAS_NUM_THREADS": "1"}
    sys.path.insert(0, str(folder))
    mutants = write_switches(folder, args.each, args.seed)
    if args.again:
        mutants = {n: one for n, one in mutants.items() if ("SURVIVED", *one.row) in again}
    runner = Runner(mutants, out, (commit, args.each, args.seed, args.tests))
    options = ["-n", "0", "-s", "-p", "no:cacheprovider", "--basetemp", str(folder / "tmp")]
    pytest.main([*options, *args.tests.split()], [runner])
    shutil.rmtree(folder)
    print(*(line for line in out.read_text("utf-8").splitlines() if "SURVIVED" in line), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
