"""Time per value and distance from the truth.

The distance is forward error in steps: how many doubles lie between the result and the correctly
rounded value. Bits of error are Herbie's log2(steps + 1): 0 is correctly rounded, 64 is a NaN.
"""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, SupportsFloat

import numpy as np

from quizgen.tradeoff.families import Family
from quizgen.tradeoff.ladder import rungs, truths
from quizgen.tradeoff.rung import Column, Rung

ARRAY = 100_000
"""Elements in a timed array."""

WORST_BITS = 64.0
KEPT_BITS = 24
"""Fewer correct bits than float32 offers count as lost."""


@dataclass(frozen=True)
class Effort:
    """How much to measure."""

    inputs: int
    scalars: int
    repeats: int


FULL = Effort(inputs=400, scalars=60, repeats=7)
QUICK = Effort(inputs=60, scalars=8, repeats=2)


@dataclass(frozen=True)
class Accuracy:
    """Errors of one way of computing over one set of inputs."""

    count: int
    max_steps: float
    mean_bits: float
    max_bits: float
    lost: float
    """Share of inputs with fewer than 24 correct bits."""


@dataclass(frozen=True)
class Measured:
    """One rung: time per value and both accuracies."""

    key: str
    kind: str
    nanoseconds: float
    exam: Accuracy
    hard: Accuracy


def steps(value: float, truth: float, turn: float = 0.0) -> float:
    """Doubles between a result and the correctly rounded value (infinity for NaN)."""
    if math.isnan(value):
        return math.inf
    if turn:
        return abs((value - truth + turn / 2) % turn - turn / 2) / math.ulp(turn)
    return float(abs(_ordinal(value) - _ordinal(truth)))


def _ordinal(value: float) -> int:
    import struct

    (bits,) = struct.unpack("<q", struct.pack("<d", value))
    return bits if bits >= 0 else -(bits & 0x7FFFFFFFFFFFFFFF)


def bits_of(count: float) -> float:
    """Herbie's bits of error."""
    return WORST_BITS if math.isinf(count) else min(WORST_BITS, math.log2(count + 1))


def accuracy(
    values: Iterable[SupportsFloat], right: Sequence[float], turn: float = 0.0
) -> Accuracy:
    """Summarise errors against correctly rounded values."""
    errors = [steps(float(v), r, turn) for v, r in zip(values, right, strict=True)]
    bits = [bits_of(error) for error in errors]
    return Accuracy(
        len(errors),
        max(errors),
        sum(bits) / len(bits),
        max(bits),
        sum(b > 53 - KEPT_BITS for b in bits) / len(bits),
    )


def best_time(call: Callable[[], Any], repeats: int) -> float:
    """Least seconds of several runs."""
    best = math.inf
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - start)
    return best


class Bench:
    """Inputs and truths of one family, and the measurement of its rungs."""

    def __init__(self, family: Family, effort: Effort) -> None:
        self.family, self.effort = family, effort
        self.sets = {}
        for name, draw in (("exam", family.exam), ("hard", family.hard)):
            rng = np.random.default_rng(20240404)
            columns = [np.asarray(c, dtype=np.float64) for c in draw(rng, effort.inputs)]
            rows = list(zip(*(c.tolist() for c in columns), strict=True))
            self.sets[name] = (columns, rows, truths(family, rows))

    def run(self) -> list[Measured]:
        """Measure every rung."""
        return [self.rung(rung) for rung in rungs(self.family)]

    def rung(self, rung: Rung) -> Measured:
        """Measure one rung."""
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            measure = self._array if rung.kind == "array" else self._scalar
            nanoseconds = measure(rung, "exam", timed=True)[1]
            exam, hard = (measure(rung, name, timed=False)[0] for name in ("exam", "hard"))
        return Measured(rung.key, rung.kind, nanoseconds, exam, hard)

    def _array(self, rung: Rung, name: str, *, timed: bool) -> tuple[Accuracy, float]:
        columns, _, right = self.sets[name]
        inputs = [rung.prepare(_whole(column)) for column in columns]
        if timed:
            long = [np.resize(column, ARRAY) if column.ndim else column for column in inputs]
            seconds = best_time(lambda: rung.run(*long), self.effort.repeats)
            return _NOTHING, seconds / ARRAY * 1e9
        finish = rung.finish if rung.finish is not float else np.asarray
        return accuracy(finish(rung.run(*inputs)), right, self.family.whole_turn), 0.0

    def _scalar(self, rung: Rung, name: str, *, timed: bool) -> tuple[Accuracy, float]:
        _, rows, right = self.sets[name]
        count = self.effort.scalars
        inputs = [rung.prepare(row) for row in rows[:count]]
        if timed:
            seconds = best_time(lambda: [rung.run(one) for one in inputs], 2)
            return _NOTHING, seconds / len(inputs) * 1e9
        values = [rung.finish(rung.run(one)) for one in inputs]
        return accuracy(values, right[:count], self.family.whole_turn), 0.0


def _whole(column: Column) -> Column | np.floating[Any]:
    """One number where all are the same: a camera is the same for all its pixels."""
    return column[0] if (column == column[0]).all() else column


_NOTHING = Accuracy(0, 0.0, 0.0, 0.0, 0.0)


def pareto(points: Sequence[tuple[float, float]]) -> list[int]:
    """Indices of points that no other point beats in both time and error, fastest first."""
    order = sorted(range(len(points)), key=lambda i: points[i])
    kept: list[int] = []
    for i in order:
        if not kept or points[i][1] < points[kept[-1]][1]:
            kept.append(i)
    return kept
