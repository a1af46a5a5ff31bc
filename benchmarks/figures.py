"""How long figures take: ``uv run python benchmarks/figures.py``.

CPU time, divided by how much slower the machine is at that moment than where the limits were set.
Of each kind, warm: a figure with numbers that were not drawn before, and its solution right after
it (median over draws, of the best of three rounds each), beside what one may take. Then the first
figure of a fresh process, over a process that has opened the bank (the best of five). Exit code 1
if one is over.
"""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage
from statistics import median
from time import process_time

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "figures"))
from figure_cases import REFERENCE, draws, module, render

from quizgen import figures
from quizgen.__main__ import ALGEBRA
from quizgen.camera import kernels
from quizgen.figures import _canvas

ROUNDS, COLD_ROUNDS, MOST_DRAWS = 3, 5, 30
WARM, COLD = 1.5, 0.35
"""Milliseconds of a figure; seconds of the first one."""
KEPT = (figures._drawn, figures._render,  # noqa: SLF001
        module("artefacts")._pair, module("depth_of_field")._photos,  # noqa: SLF001
        _canvas._png, kernels.disc, kernels.line)  # fmt: skip  # noqa: SLF001
"""What is kept under the numbers of a figure."""
LOOP, LOOP_THERE = 3_000_000, 0.13
"""Turns of a loop, and the seconds that it takes where the limits were set."""
OPENED = "import quizgen\nquizgen.builtin()\n"
FIRST = (
    OPENED
    + """from quizgen import figures
figures.render(quizgen.builtin().figure({!r}), {!r}, quiz=True, lang='en').svg"""
)


def slowness() -> float:
    """How much slower a loop is than where the limits were set."""
    start, total = process_time(), 0
    for number in range(LOOP):
        total += number * number
    return (process_time() - start) / LOOP_THERE


def once(name: str, values: Mapping[str, float]) -> tuple[float, float]:
    """Milliseconds of a figure with numbers that are new, and of its solution."""
    for kept in KEPT:
        kept.cache_clear()
    times = [process_time()]
    for quiz in (True, False):
        assert render(name, values, quiz=quiz, lang="en").svg
        times.append(process_time())
    return 1e3 * (times[1] - times[0]), 1e3 * (times[2] - times[1])


def seconds(code: str) -> float:
    """CPU seconds of a fresh process, with the threads that a command has."""

    def used() -> float:
        found = getrusage(RUSAGE_CHILDREN)
        return found.ru_utime + found.ru_stime

    before = used()
    subprocess.run([sys.executable, "-c", code], check=True, env=os.environ | {ALGEBRA: "1"})
    return used() - before


def warm() -> bool:
    """Print the table of kinds; whether one is over."""
    cases = defaultdict(list)
    for name, values in draws():
        cases[name].append(values)
    print(f"{'figure':<16} {'new':>6} {'solution':>9} {'slower':>6}  ms of {WARM}")
    over = False
    for name, reference in REFERENCE.items():
        once(name, reference)
        some = [reference, *cases[name]][:: len(cases[name]) // MOST_DRAWS + 1]
        slow = slowness()
        rounds = [[once(name, values) for values in some] for _ in range(ROUNDS)]
        slow = (slow + slowness()) / 2
        new, solution = (
            median(min(row[which] for row in rows) for rows in zip(*rounds, strict=True)) / slow
            for which in (0, 1)
        )
        over = over or new > WARM
        print(f"{name:<16} {new:6.2f} {solution:9.2f} {slow:6.2f}{'  OVER' * (new > WARM)}")
    return over


def cold() -> bool:
    """Print what the first figure takes; whether one is over."""
    codes = {"opened": OPENED} | {
        name: FIRST.format(name, REFERENCE[name]) for name in ("thin_lens", "artefacts")
    }
    slow = slowness()
    rounds = [[seconds(code) for code in codes.values()] for _ in range(COLD_ROUNDS)]
    slow = (slow + slowness()) / 2
    opened, *firsts = map(min, zip(*rounds, strict=True))
    for name, first in zip(("line figure", "photograph"), firsts, strict=True):
        more = (first - opened) / slow
        print(f"first {name:<12} {more:.3f} CPU s of {COLD}{'  OVER' * (more > COLD)}")
    return (max(firsts) - opened) / slow > COLD


if __name__ == "__main__":
    gc.disable()
    sys.exit(any([warm(), cold()]))
