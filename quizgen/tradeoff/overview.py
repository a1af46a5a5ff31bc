"""The one picture: correct digits against time for every formula, from printed to stable to exact.

Each family is a thin line through its three ways, with its number; the thick arrows are the medians
over all families and say in words what a step costs and brings.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from quizgen.tradeoff.digits import ALL_DIGITS
from quizgen.tradeoff.labels import Box, Labels
from quizgen.tradeoff.measure import Measured
from quizgen.tradeoff.plot import (
    BOUNDS,
    HEIGHT,
    LEFT,
    RIGHT,
    Axes,
    Scale,
    circle,
    digit_axis,
    frame,
    joined,
    label,
    line,
    path,
    text,
    time_text,
)
from quizgen.tradeoff.report import EXACT, FamilyReport, Report

INPUTS = ("exam", "hard")
_X = Scale(0.3, 3e5, LEFT, RIGHT, log=True)
_Y = Scale(0.0, ALL_DIGITS, HEIGHT - 46, 44)


@dataclass(frozen=True)
class Way:
    """Time per value in nanoseconds and correct digits."""

    time: float
    digits: float


@dataclass(frozen=True)
class Road:
    """A family's three ways: as printed, stable, proven."""

    printed: Way
    stable: Way
    proven: Way

    def __iter__(self) -> Iterator[Way]:
        """From the fastest to the surest."""
        return iter((self.printed, self.stable, self.proven))


@dataclass(frozen=True)
class Cost:
    """What a step from one way to another costs and brings: times slower, digits before, after."""

    slower: float
    before: float
    after: float


def proven(family: FamilyReport) -> Measured:
    """The cheapest way whose answer is proven."""
    return min((r for r in family.rungs if r.key in EXACT), key=lambda r: r.nanoseconds)


def road(family: FamilyReport, inputs: str) -> Road:
    """The three ways of a family on exam or on hard inputs."""
    rungs = {rung.key: rung for rung in family.rungs}
    ways = (rungs["float64"], rungs["stable"], proven(family))
    return Road(*(Way(way.nanoseconds, getattr(way, inputs).digits) for way in ways))


def cost(one: Way, other: Way) -> Cost:
    """What the step between two ways costs and brings."""
    return Cost(other.time / one.time, one.digits, other.digits)


def middle(roads: Sequence[Road]) -> Road:
    """Medians over families."""
    columns = zip(*roads, strict=True)
    return Road(
        *(
            Way(statistics.median(w.time for w in ways), statistics.median(w.digits for w in ways))
            for ways in columns
        )
    )


def digits_text(count: float, every: str) -> str:
    """Whole correct digits, or the word for all of them."""
    return every if count >= ALL_DIGITS else str(int(count))


def factor_text(factor: float) -> str:
    """How many times, in two or three figures."""
    if factor < 0.095:
        return f"{factor:.1g}"
    return f"{factor:.1f}" if factor < 10 else f"{factor:.0f}" if factor < 1000 else grouped(factor)


def grouped(number: float) -> str:
    """A large number in two figures, its thousands apart."""
    size = 10 ** (math.floor(math.log10(number)) - 1)
    return f"{round(number / size) * size:,}".replace(",", "\u202f")


def cost_text(step: Cost, said: dict[str, str]) -> str:
    """A step in words: × 1.8 slower, 3 -> 15 digits."""
    if 0.95 <= step.slower < 1.05:
        head = said["same"]
    elif step.slower < 1:
        head = said["faster"].format(times=factor_text(1 / step.slower))
    else:
        head = said["slower"].format(times=factor_text(step.slower))
    before, after = (digits_text(count, said["every"]) for count in (step.before, step.after))
    return said["digits_same" if before == after else "digits_from"].format(
        cost=head, before=before, after=after
    )


def panel(report: Report, inputs: str, title: str, axes: Axes, said: dict[str, str]) -> str:
    """All families on exam or on hard inputs."""
    roads = [road(family, inputs) for family in report.families]
    median = middle(roads)
    labels = Labels(BOUNDS)
    parts = [text(RIGHT, 15, title, "end", "head"), frame(_X, _Y)]
    parts += [digit_axis(_Y, _X, axes.digits, axes.every), _times(axes.time)]
    for one in (*roads, median):
        for way in one:
            labels.keep_clear(*_at(way), 4)
    parts += [path(map(_at, one), "thin off") for one in roads]
    parts += [_points(one, inputs) for one in roads]
    parts += _steps(median, labels, said)
    labels.size = 11
    for number, one in enumerate(roads, 1):
        parts.append(label(labels.place(str(number), *_at(one.printed))))
    return "".join(parts)


def _steps(median: Road, labels: Labels, said: dict[str, str]) -> list[str]:
    """Both arrows with their words: the second step above its arrow, the first beside its own."""
    start, middle, end = map(_at, median)
    above = cost_text(cost(median.stable, median.proven), said)
    beside = cost_text(cost(median.printed, median.stable), said)
    labels.size = 12
    labels.written(RIGHT, _Y.end - 10, above, "end")
    for (x1, y1), (x2, y2) in ((start, middle), (middle, end)):
        for share in np.linspace(0, 1, 60):
            labels.keep_clear(x1 + share * (x2 - x1), y1 + share * (y2 - y1), 4)
    labels.taken.append(Box(middle[0] + 10, end[1], RIGHT, middle[1] + 40))  # read as the second's
    half_way = (start[0] + middle[0]) / 2, (start[1] + middle[1]) / 2
    return [
        _arrow(start, middle),
        _arrow(middle, end),
        text(RIGHT, _Y.end - 10, above, "end", "head"),
        label(labels.place(beside, *half_way), "head"),
    ]


LANE, LANES_TOP, LANES_BOTTOM = 50, 26, 40
"""Height of a formula's line, and the room above the first one and below the last one."""


def lanes_height(report: Report) -> int:
    """Height of the picture that ``lanes`` draws."""
    return LANES_TOP + LANE * len(report.families) + LANES_BOTTOM


def lanes(report: Report, said: dict[str, str], time: str) -> str:
    """Each formula on a line of its own: both arrows along time, each with its words.

    The first step is said above the line, the second one below it, so that no words meet.
    """
    bottom = lanes_height(report) - LANES_BOTTOM
    parts = [text(RIGHT, 15, said["each"], "end", "head")]
    for at in (1.0, 10.0, 100.0, 1e3, 1e4, 1e5):
        parts.append(line(_X(at), bottom, _X(at), LANES_TOP, "grid"))
        parts.append(text(_X(at), bottom + 16, time_text(at)))
    for number, family in enumerate(report.families, 1):
        y = LANES_TOP + LANE * number - LANE / 2
        parts += [text(14, y + 4, str(number), kind="head"), *_lane(road(family, "hard"), y, said)]
    return "".join([*parts, text(RIGHT, bottom + 32, time, "end")])


def _lane(one: Road, y: float, said: dict[str, str]) -> list[str]:
    a, b, c = ((_X(way.time), y) for way in one)
    first, second = cost(one.printed, one.stable), cost(one.stable, one.proven)
    return [
        text(LEFT, y - 10, cost_text(first, said), "start"),
        text(RIGHT, y + 20, cost_text(second, said), "end"),
        _arrow(b, c),
        _arrow(a, b),
        circle(*a, "second", 4),
    ]


def _at(way: Way) -> tuple[float, float]:
    return _X(way.time), _Y(way.digits)


def _times(name: str) -> str:
    parts = [text(RIGHT, HEIGHT - 8, name, "end")]
    for at in (1.0, 10.0, 100.0, 1e3, 1e4, 1e5):
        parts.append(line(_X(at), _Y.start, _X(at), _Y.end, "grid"))
        parts.append(text(_X(at), _Y.start + 15, time_text(at)))
    return "".join(parts)


def _points(one: Road, inputs: str) -> str:
    """Circle, square, diamond; filled on hard inputs."""
    full = {"exam": "off", "hard": ""}[inputs]
    (ax, ay), (bx, by), (cx, cy) = map(_at, one)
    diamond = f"M{cx:.1f} {cy - 5:.1f}l5 5l-5 5l-5-5z"
    return (
        circle(ax, ay, full or "second", 4)
        + f'<rect x="{bx - 3.5:.1f}" y="{by - 3.5:.1f}" width="7" height="7" '
        f'class="{full or "on"}"/><path d="{diamond}" class="{full or "third"}"/>'
    )


def _arrow(start: tuple[float, float], end: tuple[float, float]) -> str:
    (x1, y1), (x2, y2) = start, end
    size = max(((x2 - x1) ** 2 + (y2 - y1) ** 2) ** 0.5, 1e-9)
    ux, uy = (x2 - x1) / size, (y2 - y1) / size
    bx, by = x2 - 9 * ux, y2 - 9 * uy
    head = joined([end, (bx - 5 * uy, by + 5 * ux), (bx + 5 * uy, by - 5 * ux)])
    return path([start, (bx, by)], "front arrow") + f'<polygon points="{head}" class="on"/>'
