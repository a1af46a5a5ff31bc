"""Times of calls that do the same, taken in turns, so that what else the machine does hits all."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Timing:
    """Seconds of several runs: the least, which is nearest to the work itself, and the median."""

    least: float
    median: float

    def per(self, count: float) -> Timing:
        """The same for one of so many."""
        return Timing(self.least / count, self.median / count)


def in_turns(calls: Sequence[Callable[[], Any]], runs: int) -> list[Timing]:
    """Time calls, one after the other and all over again; the first round warms up."""
    spent: list[list[float]] = [[] for _ in calls]
    for turn in range(runs + 1):
        for call, seconds in zip(calls, spent, strict=True):
            start = time.perf_counter()
            call()
            if turn:
                seconds.append(time.perf_counter() - start)
    return [Timing(min(seconds), statistics.median(seconds)) for seconds in spent]
