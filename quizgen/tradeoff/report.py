"""Measure everything once: plain data that the page, the JSON and the SVGs are written from."""

from __future__ import annotations

import platform
import time
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from quizgen.tradeoff.families import BY_NAME, FAMILIES, Family
from quizgen.tradeoff.knobs import KNOBS, Curve, Knob
from quizgen.tradeoff.measure import (
    FULL,
    QUICK,
    Accuracy,
    Bench,
    Effort,
    Measured,
    accuracy,
    best_time,
)
from quizgen.tradeoff.peers import peers

Progress = Callable[[str], None]
"""Told the name of what is measured next."""


def silent(_name: str) -> None:
    """Progress that nobody watches."""


EXACT = {"exact", "arb"}
"""Rungs whose answer is proven."""


@dataclass(frozen=True)
class FamilyReport:
    """Measurements of one family."""

    name: str
    formula: str
    tolerance: float
    rungs: tuple[Measured, ...]
    peers: tuple[tuple[str, Accuracy, Accuracy], ...]


@dataclass(frozen=True)
class Report:
    """Everything the page shows."""

    families: tuple[FamilyReport, ...]
    knobs: tuple[tuple[str, tuple[Curve, ...]], ...]
    effort: Effort
    ladder_seconds: float
    figure_seconds: float
    machine: str
    seconds: float


def measure(
    names: Iterable[str] = (), *, quick: bool = False, progress: Progress = silent
) -> Report:
    """Measure the named families (all of them by default).

    Parameters
    ----------
    names : iterable of str
    quick : bool
        Fewer inputs.
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
    return Report(
        families, curves, effort, _ladder(families), _figure(), _machine(),
        time.perf_counter() - start,
    )  # fmt: skip


def _knob(knob: Knob, effort: Effort, progress: Progress) -> tuple[str, tuple[Curve, ...]]:
    progress(knob.key)
    return knob.key, tuple(knob.measure(effort))


def _family(family: Family, effort: Effort, progress: Progress) -> FamilyReport:
    progress(family.name)
    bench = Bench(family, effort)
    others = tuple(_peer(bench, label, call) for label, call in peers(family.name).items())
    return FamilyReport(family.name, _formula(family), family.tolerance, tuple(bench.run()), others)


def _formula(family: Family) -> str:
    from quizgen.maths.notation import to_text

    return "" if family.formula is None else to_text(family.formula)


def _peer(bench: Bench, label: str, call: Callable[..., Any]) -> tuple[str, Accuracy, Accuracy]:
    found = []
    for name in ("exam", "hard"):
        columns, _, right = bench.sets[name]
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            found.append(accuracy(list(call(*columns)), right, bench.family.whole_turn))
    return label, found[0], found[1]


def _ladder(families: Iterable[FamilyReport]) -> float:
    """Largest sum over a family of all proven rungs, in seconds per question."""
    sums = [sum(r.nanoseconds for r in f.rungs if r.key in EXACT) for f in families]
    return max(sums) * 1e-9


def _figure() -> float:
    """Seconds for one warm figure with a new number each time."""
    from itertools import count

    from quizgen.figures import render

    sigmas = count(20)
    render("gaussian", {"sigma": 19.0, "k": 2.0}, quiz=False, lang="en")

    def draw() -> None:
        render("gaussian", {"sigma": float(next(sigmas)), "k": 2.0}, quiz=False, lang="en")

    return best_time(draw, 3)


def _machine() -> str:
    return (
        f"{platform.system()} {platform.machine()}, Python {platform.python_version()}, "
        f"NumPy {np.__version__}"
    )
