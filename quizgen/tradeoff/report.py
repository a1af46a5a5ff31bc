"""Measure everything once: plain data that the page, the JSON and the SVGs are written from."""

from __future__ import annotations

import os
import platform
import time
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import count
from typing import Any

import numpy as np

from quizgen.tradeoff.families import BY_NAME, FAMILIES, Family
from quizgen.tradeoff.knobs import KNOBS, Knob
from quizgen.tradeoff.measure import (
    ARRAY,
    FULL,
    QUICK,
    Accuracy,
    Bench,
    Effort,
    Measured,
    Timing,
    accuracy,
    timed,
)
from quizgen.tradeoff.peers import peers
from quizgen.tradeoff.product import Product, measure_product, today
from quizgen.tradeoff.sweeps import Sweep, sweep
from quizgen.tradeoff.work import Curve

Progress = Callable[[str], None]
"""Told the name of what is measured next."""


def silent(_name: str) -> None:
    """Progress that nobody watches."""


SLOW = 3e-7
"""Seconds per value from which a library is timed on few values."""

EXACT = {"exact", "arb"}
"""Rungs whose answer is proven."""


@dataclass(frozen=True)
class Peer:
    """Another library: time per value and both accuracies."""

    name: str
    time: Timing
    exam: Accuracy
    hard: Accuracy


@dataclass(frozen=True)
class FamilyReport:
    """Measurements of one family.

    Parameters
    ----------
    name, formula : str
    tolerance : float
        Relative tolerance of grading.
    rungs : tuple of Measured
    peers : tuple of Peer
    checks : Timing
        Time per value of looking at every argument once, which no rung needs for its digits.
    one_line : bool
        Whether the stable way is one plain line of NumPy.
    sweep : Sweep
        Its digits along a path of inputs.
    """

    name: str
    formula: str
    tolerance: float
    rungs: tuple[Measured, ...]
    peers: tuple[Peer, ...]
    checks: Timing
    one_line: bool
    sweep: Sweep


@dataclass(frozen=True)
class Report:
    """Everything the page shows."""

    families: tuple[FamilyReport, ...]
    knobs: tuple[tuple[str, tuple[Curve, ...]], ...]
    product: Product | None
    effort: Effort
    figure: Timing
    machine: str
    date: str
    seconds: float


def measure(
    names: Iterable[str] = (), *, quick: bool = False, drawn: int = 0, progress: Progress = silent
) -> Report:
    """Measure the named families (by default all of them, the settings and the whole product).

    Parameters
    ----------
    names : iterable of str
    quick : bool
        Fewer inputs.
    drawn : int
        Questions to draw to count faults of the product anew; 0 for what is recorded.
    progress : callable
        Told the name of each family and knob before it is measured.

    Raises
    ------
    OraclesDisagree
        If two independent references differ.
    """
    start = time.perf_counter()
    effort = QUICK if quick else FULL
    chosen = [BY_NAME[name] for name in names] or list(FAMILIES)
    families = tuple(_family(family, effort, progress) for family in chosen)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        curves = () if names else tuple(_knob(knob, effort, progress) for knob in KNOBS)
    product = None if names else measure_product(drawn, effort.papers, progress)
    return Report(
        families, curves, product, effort, _figure(), _machine(), today(),
        time.perf_counter() - start,
    )  # fmt: skip


def _knob(knob: Knob, effort: Effort, progress: Progress) -> tuple[str, tuple[Curve, ...]]:
    progress(knob.key)
    return knob.key, tuple(knob.measure(effort))


def _family(family: Family, effort: Effort, progress: Progress) -> FamilyReport:
    progress(family.name)
    bench = Bench(family, effort)
    there = peers(family.name, slow=effort.slow)
    others = tuple(_peer(bench, label, call) for label, call in there.items())
    return FamilyReport(
        family.name, _formula(family), family.tolerance, tuple(bench.run()), others,
        bench.checks(), family.one_line, sweep(family, effort.places),
    )  # fmt: skip


def _formula(family: Family) -> str:
    from quizgen.maths.notation import to_text

    return "" if family.formula is None else to_text(family.formula)


def _peer(bench: Bench, label: str, call: Callable[..., Any]) -> Peer:
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        return Peer(
            label,
            _peer_time(bench, call),
            *(_peer_accuracy(bench, name, call) for name in ("exam", "hard")),
        )


def _peer_accuracy(bench: Bench, name: str, call: Callable[..., Any]) -> Accuracy:
    columns, _, right = bench.sets[name]
    return accuracy(list(call(*columns)), right, bench.family.whole_turn)


def _peer_time(bench: Bench, call: Callable[..., Any]) -> Timing:
    """Time per value: of few values where one takes long, as it does in Python."""
    columns = bench.sets["exam"][0]
    few = timed(lambda: call(*columns), 2).per(len(columns[0]))
    if few.median > SLOW:
        return few
    long = [np.resize(column, ARRAY) for column in columns]
    return timed(lambda: call(*long), bench.effort.repeats).per(ARRAY)


# Of figures that nothing has drawn: this process and those of other days have kept theirs.
_SIGMAS = count(1_000_000 + time.time_ns() // 1000 % 1_000_000)


def _figure() -> Timing:
    """Time of one warm figure with a new number each time."""
    from quizgen.bank.folder import builtin
    from quizgen.figures import draw_figure

    figure = builtin().figure("gaussian")

    def draw() -> None:
        draw_figure(figure, {"sigma": next(_SIGMAS) / 1e6, "k": 2.0}, quiz=False, lang="en")

    draw()
    return timed(draw, 5)


def _machine() -> str:
    return (
        f"{platform.system()} {platform.machine()}, {os.cpu_count()} CPU, "
        f"Python {platform.python_version()}, NumPy {np.__version__}"
    )
