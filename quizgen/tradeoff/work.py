"""Points and lines of a work-precision plot: what each setting costs and what error it leaves."""

from __future__ import annotations

from dataclasses import dataclass

from quizgen.tradeoff.measure import Timing


@dataclass(frozen=True)
class Point:
    """One setting: its label, the time of a fixed piece of work, the error it leaves, a remark.

    ``precision`` is what it was computed in, where settings differ in that.
    """

    label: str
    time: Timing
    error: float
    note: str = ""
    precision: str = ""


@dataclass(frozen=True)
class Curve:
    """One line of a work-precision plot."""

    label: str
    points: tuple[Point, ...]
