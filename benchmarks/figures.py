"""How long figures take: ``uv run python benchmarks/figures.py [name ...]``.

CPU time, divided by how much slower the machine is at that moment than where the limits were set.
Each built-in figure and the untuned plots of ``docs/figures.md``, warm, with values that were not
drawn before, in the quiz and in the solution (median over draws, the best of three rounds); the
same drawing code on stock axes through matplotlib's own SVG backend beside it; figures that are
found among what is kept; and the first figure of a fresh process over one that has opened the bank.
Exit code 1 if one is over.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from random import Random
from resource import RUSAGE_CHILDREN, getrusage
from statistics import median
from time import process_time
from types import ModuleType
from typing import Any

os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp()  # nothing is kept yet

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "figures"))
from documented import VALUES, load_examples
from figure_cases import FIGURES, REFERENCE, draws, module
from matplotlib.figure import Figure as StockFigure

from quizgen import figures
from quizgen.core import cache
from quizgen.figures import complete_parameters, draw_figure
from quizgen.figures.axes import Sheet
from quizgen.figures.contract import parameters_of
from quizgen.figures.engine import HouseStyle
from quizgen.figures.kit import COLUMN

MOST_DRAWS, ROUNDS, STOCK_DRAWS, COLD_ROUNDS = 30, 3, 8, 5
MIDDLE, LARGEST, NEWCOMER, KEPT = 5.0, 12.0, 12.0, 0.2
"""Milliseconds: the median of all, any, an author's untuned plot, the median of kept ones."""
COLD = 0.6
"""Seconds of the first one, with compiled bytecode."""
LOOP, LOOP_THERE = 3_000_000, 0.13
"""Turns of a loop, and the seconds that it takes where the limits were set."""
OPENED = "import quizgen\nquizgen.builtin()\n"
FIRST = OPENED + (
    "from quizgen.figures import draw_figure\n"
    "draw_figure(quizgen.builtin().figure({!r}), {!r}, quiz=True, lang='en').inline_svg"
)

Values = Mapping[str, Any]

ALGEBRA = "OPENBLAS_NUM_THREADS"  # as quizgen sets it


def slowness() -> float:
    """How much slower a loop is than where the limits were set."""
    start, total = process_time(), 0
    for number in range(LOOP):
        total += number * number
    return (process_time() - start) / LOOP_THERE


def milliseconds(work: Callable[[], object]) -> float:
    start = process_time()
    work()
    return 1e3 * (process_time() - start)


@contextmanager
def nothing_kept() -> Iterator[None]:
    """Have every figure drawn."""
    find, keep = cache.read_cached, cache.write_cached
    cache.read_cached, cache.write_cached = (lambda *_: None), (lambda *_: None)
    try:
        yield
    finally:
        cache.read_cached, cache.write_cached = find, keep


class StockSheet(Sheet):
    """A sheet whose axes are matplotlib's own."""

    add_subplot = StockFigure.add_subplot
    add_axes = StockFigure.add_axes


def draw_stock(figure: ModuleType, values: Values, *, quiz: bool) -> None:
    """The same content by matplotlib's own axes and backend."""
    values = complete_parameters(figure, values)
    with HouseStyle():
        sheet = StockSheet(*getattr(figure, "SIZE", COLUMN))
        names = parameters_of(figure.draw)
        place = sheet.add_axes((0, 0, 1, 1)) if names[0] == "ax" else sheet
        figure.draw(place, values, quiz=quiz, **({"lang": "en"} if "lang" in names else {}))
        sheet.savefig(io.BytesIO(), format="svg", metadata={"Date": None})


def time_drawing(figure: ModuleType, values: Values, *, quiz: bool) -> float:
    """Milliseconds of a figure."""
    return milliseconds(lambda: draw_figure(figure, values, quiz=quiz, lang="en"))


def time_figure(figure: ModuleType, some: Sequence[Values]) -> tuple[float, float, float, float]:
    """Milliseconds of quiz, solution and stock, and slowness: the best of some rounds.

    Each round has other values, as what is drawn twice is found among what is kept; the first draw
    of all only warms up.
    """
    rounds, slow = [], [slowness()]
    figures._draw_items.cache_clear()  # noqa: SLF001
    with nothing_kept():
        for quiz in (True, False):
            time_drawing(figure, some[0], quiz=quiz)
        for start in range(1, min(ROUNDS, len(some) - 1) + 1):
            few = some[start::ROUNDS]
            ours = [[time_drawing(figure, one, quiz=quiz) for quiz in (True, False)] for one in few]
            slow.append(slowness())
            now = sum(slow[-2:]) / 2
            rounds.append([median(column) / now for column in zip(*ours, strict=True)])
        stock = [
            milliseconds(lambda values=values: draw_stock(figure, values, quiz=False))
            for values in some[:STOCK_DRAWS]
        ]
    quiz, solution = (min(column) for column in zip(*rounds, strict=True))
    return quiz, solution, median(stock[1:]) / slow[-1], min(slow)


def time_kept(figure: ModuleType, values: Values) -> float:
    """Milliseconds of a figure that an earlier process has drawn."""
    draw_figure(figure, values, quiz=False, lang="en")
    times = []
    for _ in range(15):
        figures._draw_items.cache_clear()  # noqa: SLF001
        times.append(time_drawing(figure, values, quiz=False))
    return median(times)


def seconds(code: str) -> float:
    """CPU seconds of a fresh process that finds nothing kept, with the threads of a command."""

    def used() -> float:
        found = getrusage(RUSAGE_CHILDREN)
        return found.ru_utime + found.ru_stime

    with tempfile.TemporaryDirectory() as folder:
        before = used()
        settings = os.environ | {ALGEBRA: "1", "XDG_CACHE_HOME": folder}
        subprocess.run([sys.executable, "-c", code], check=True, env=settings)
        return used() - before


def print_row(name: str, times: tuple[float, float, float, float], from_kept: float) -> None:
    quiz, solution, stock, slow = times
    ratio = stock / max(quiz, solution)
    print(
        f"{name:<22}{quiz:7.2f}{solution:10.2f}{from_kept:7.2f}{stock:8.1f}{ratio:7.1f}{slow:8.2f}"
    )


def warm(names: Sequence[str]) -> bool:
    """Print the table of the built-in figures; whether one is over."""
    cases = defaultdict(list)
    for name, values in draws():
        cases[name].append(values)
    print(
        f"{'ms of CPU':<22}{'quiz':>7}{'solution':>10}{'kept':>7}{'stock':>8}{'x':>7}{'slower':>8}"
    )
    all_quiz, all_solutions, all_stock, all_kept = [], [], [], []
    for name in names:
        figure = module(name)
        step = len(cases[name]) // MOST_DRAWS + 1
        some = [REFERENCE[name], *cases[name][::step]]
        times = time_figure(figure, some)
        from_kept = time_kept(figure, REFERENCE[name]) / times[3]
        print_row(name, times, from_kept)
        for column, value in zip(
            (all_quiz, all_solutions, all_stock, all_kept), (*times[:3], from_kept), strict=True
        ):
            column.append(value)
    middle, largest = median(all_quiz + all_solutions), max(all_quiz + all_solutions)
    from_kept = median(all_kept)
    print(
        f"median {middle:.2f} of {MIDDLE:g}, largest {largest:.2f} of {LARGEST:g}, "
        f"kept {from_kept:.2f} of {KEPT:g} (at most {max(all_kept):.2f}), "
        f"stock {median(all_stock):.1f}"
    )
    return middle > MIDDLE or largest > LARGEST or from_kept > KEPT


def newcomers() -> bool:
    """Print what the plots of the documentation take; whether one of the untuned is over."""
    rng, over = Random(35), False
    with tempfile.TemporaryDirectory() as folder:
        for name, figure in load_examples(Path(folder)).items():
            rules = figure.PARAMETERS
            some = [
                VALUES.get(name, {}) | {
                    key: [rng.gauss(12, 4) for _ in range(40)] if rule.kind == "list"
                    else rng.uniform(max(rule.low, 0.5), min(rule.high, 200))
                    for key, rule in rules.items()
                }
                for _ in range(20)
            ]  # fmt: skip
            times = time_figure(figure, some)
            print_row(name, times, time_kept(figure, some[0]) / times[3])
            over = over or (name in {"box_plot", "bode"} and max(times[:2]) > NEWCOMER)
    print(f"box plot and Bode plot of {NEWCOMER:g}")
    return over


def cold() -> bool:
    """Print what the first figure takes; whether one is over."""
    codes = {"opened": OPENED} | {
        name: FIRST.format(name, REFERENCE[name]) for name in ("thin_lens", "gaussian", "artefacts")
    }
    slow = slowness()
    rounds = [[seconds(code) for code in codes.values()] for _ in range(COLD_ROUNDS)]
    slow = (slow + slowness()) / 2
    opened, *firsts = map(min, zip(*rounds, strict=True))
    kinds = ("sketch", "plot", "photograph")
    for name, first in zip(kinds, firsts, strict=True):
        more = (first - opened) / slow
        print(f"first {name:<12} {more:.3f} CPU s of {COLD}{'  OVER' * (more > COLD)}")
    return (max(firsts) - opened) / slow > COLD


if __name__ == "__main__":
    chosen = sys.argv[1:]
    sys.exit(any([warm(chosen or FIGURES), *([] if chosen else [newcomers(), cold()])]))
