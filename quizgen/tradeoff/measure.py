"""Time per value and distance from the truth.

For people the distance is correct decimal digits, 0 to 16, or all of them; in the details it is
forward error in steps: how many doubles lie between the result and the correctly rounded value.
Bits of error are Herbie's log2(steps + 1): 0 is correctly rounded, 64 is a NaN.
"""

from __future__ import annotations

import math
import statistics
import time
import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, SupportsFloat

import numpy as np

from quizgen.arrays.kernel import BLOCK
from quizgen.tradeoff.digits import digits
from quizgen.tradeoff.families import Family
from quizgen.tradeoff.ladder import rungs, truths
from quizgen.tradeoff.rung import Column, Rung

ARRAY = 100_000
"""Elements in a timed array."""

WORST_BITS = 64.0
KEPT_BITS = 24
"""Fewer correct bits than float32 offers count as lost."""
PATIENCE = 0.02
"""Seconds after which inputs that were tried one by one are not tried again."""


@dataclass(frozen=True)
class Effort:
    """How much to measure."""

    inputs: int
    scalars: int
    repeats: int
    papers: int
    places: int
    scenes: int
    photos: int
    slow: bool
    """Whether libraries are tried, too, that take half a second to load."""


FULL = Effort(inputs=400, scalars=60, repeats=7, papers=7, places=41, scenes=8, photos=2, slow=True)
QUICK = Effort(inputs=30, scalars=4, repeats=3, papers=2, places=21, scenes=2, photos=1, slow=False)


@dataclass(frozen=True)
class Accuracy:
    """Errors of one way of computing over one set of inputs."""

    count: int
    max_steps: float
    mean_bits: float
    max_bits: float
    lost: float
    """Share of inputs with fewer than 24 correct bits."""
    digits: float
    """Correct decimal digits of the worst result; 17 if all of all results are."""


@dataclass(frozen=True)
class Timing:
    """Seconds of several runs of the same: the median, and the quartiles around it."""

    median: float
    low: float
    high: float

    def per(self, count: float) -> Timing:
        """The same for one of so many."""
        return Timing(self.median / count, self.low / count, self.high / count)


@dataclass(frozen=True)
class Measured:
    """One rung: time per value and both accuracies."""

    key: str
    kind: str
    time: Timing
    exam: Accuracy
    hard: Accuracy

    @property
    def nanoseconds(self) -> float:
        """Median time per value."""
        return 1e9 * self.time.median


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
    pairs = [(float(v), r) for v, r in zip(values, right, strict=True)]
    errors = [steps(v, r, turn) for v, r in pairs]
    bits = [bits_of(error) for error in errors]
    return Accuracy(
        len(errors),
        max(errors),
        sum(bits) / len(bits),
        max(bits),
        sum(b > 53 - KEPT_BITS for b in bits) / len(bits),
        min(digits(v, r, turn) for v, r in pairs),
    )


def timed(call: Callable[[], Any], repeats: int) -> Timing:
    """Time several runs."""
    spent = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        spent.append(time.perf_counter() - start)
    return spread(spent)


def timed_each(
    call: Callable[[Any], Any], inputs: Sequence[Any], repeats: int
) -> tuple[Timing, list[Any]]:
    """Time each of several inputs, again if all together take no time; and what came out."""
    spent: list[float] = []
    for _ in range(repeats):
        results = []
        for one in inputs:
            start = time.perf_counter()
            result = call(one)
            spent.append(time.perf_counter() - start)
            results.append(result)
        if sum(spent) > PATIENCE:
            break
    return spread(spent), results


def spread(seconds: Sequence[float]) -> Timing:
    """Median and quartiles of what was measured."""
    if len(seconds) == 1:
        return Timing(seconds[0], seconds[0], seconds[0])
    low, middle, high = statistics.quantiles(seconds, n=4, method="inclusive")
    return Timing(middle, low, high)


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
        """Measure every rung; a formula that is stable as printed is timed once."""
        found = [self.rung(rung) for rung in rungs(self.family, slow=self.effort.slow)]
        if self.family.printed is not self.family.stable:
            return found
        printed = next(rung.time for rung in found if rung.key == "float64")
        return [replace(rung, time=printed) if rung.key == "stable" else rung for rung in found]

    def rung(self, rung: Rung) -> Measured:
        """Measure one rung."""
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            if rung.kind == "scalar":
                return Measured(rung.key, rung.kind, *self._scalar(rung))
            exam, hard = (self._array(rung, name) for name in ("exam", "hard"))
            return Measured(rung.key, rung.kind, self._array_time(rung), exam, hard)

    def checks(self) -> Timing:
        """Time per value of looking at every argument once, as the array functions do first."""
        long = [np.resize(column, ARRAY) for column in self.sets["exam"][0]]

        def look() -> None:
            for start in range(0, ARRAY, BLOCK):
                for column in long:
                    part = column[start : start + BLOCK]
                    part.min(), part.max()

        return timed(look, self.effort.repeats).per(ARRAY)

    def _array_time(self, rung: Rung) -> Timing:
        inputs = [rung.prepare(_whole(column)) for column in self.sets["exam"][0]]
        long = [np.resize(column, ARRAY) if column.ndim else column for column in inputs]
        return timed(lambda: rung.run(*long), self.effort.repeats).per(ARRAY)

    def _array(self, rung: Rung, name: str) -> Accuracy:
        columns, _, right = self.sets[name]
        inputs = [rung.prepare(_whole(column)) for column in columns]
        finish = rung.finish if rung.finish is not float else np.asarray
        return accuracy(finish(rung.run(*inputs)), right, self.family.whole_turn)

    def _scalar(self, rung: Rung) -> tuple[Timing, Accuracy, Accuracy]:
        """Time of exam inputs one by one, and the digits of these and of hard ones."""
        count = self.effort.scalars
        inputs = {name: [rung.prepare(row) for row in rows[:count]]
                  for name, (_, rows, _) in self.sets.items()}  # fmt: skip
        spent, found = timed_each(rung.run, inputs["exam"], self.effort.repeats)
        hard = [rung.run(one) for one in inputs["hard"]]
        return spent, self._right("exam", rung, found), self._right("hard", rung, hard)

    def _right(self, name: str, rung: Rung, found: Sequence[Any]) -> Accuracy:
        right = self.sets[name][2][: len(found)]
        return accuracy(map(rung.finish, found), right, self.family.whole_turn)


def _whole(column: Column) -> Column | np.floating[Any]:
    """One number where all are the same: a camera is the same for all its pixels."""
    return column[0] if (column == column[0]).all() else column


def pareto(points: Sequence[tuple[float, float]]) -> list[int]:
    """Indices of points that no other point beats in both time and error, fastest first."""
    order = sorted(range(len(points)), key=lambda i: points[i])
    kept: list[int] = []
    for i in order:
        if not kept or points[i][1] < points[kept[-1]][1]:
            kept.append(i)
    return kept
