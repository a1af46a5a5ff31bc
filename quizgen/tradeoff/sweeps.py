"""Error against the input, as Herbie shows it: one quantity of a formula moves, and digits vanish.

Every family has a path from inputs of an exam to its weak spot; along it the printed formula and
the stable form are compared with the exact value.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from quizgen.tradeoff.digits import digits
from quizgen.tradeoff.families import Columns, Family
from quizgen.tradeoff.ladder import rungs, truths
from quizgen.tradeoff.rung import Column, Rung

WAYS = ("float32", "float64", "stable")
"""Rungs that are followed."""
HALF_LEVEL = 0.5 / 255
"""Half a step of an 8-bit pixel."""
_FOLD = 2 / (3 * math.sqrt(0.6))


@dataclass(frozen=True)
class Path:
    """What moves, from easy to hard, and the inputs that belong to it."""

    symbol: str
    easy: float
    hard: float
    columns: Callable[[Column], Columns]
    log: bool = True

    def places(self, count: int) -> Column:
        """Values of what moves; short decimals on a logarithmic path."""
        if not self.log:
            return np.linspace(self.easy, self.hard, count)
        ends = math.log10(self.easy), math.log10(self.hard)
        return np.array([float(f"{10**e:.1e}") for e in np.linspace(*ends, count).tolist()])


def _same(value: float, like: Column) -> Column:
    return np.full(like.size, value)


PATHS = {
    "gaussian-tail": Path("k", 1, 12, lambda t: [t], log=False),
    "thin-lens": Path("(z − f)/f", 10, 1e-14, lambda t: [_same(50, t), 50 * (1 + t)]),
    "blur-disc": Path(
        "(z − s)/s", 1, 1e-14,
        lambda t: [_same(50, t), _same(2.8, t), _same(3000, t), 3000 * (1 + t)],
    ),
    "far-limit": Path(
        "1 − s/H", 0.9, 1e-14,
        lambda t: [_same(50, t), _same(8, t), _same(0.03, t), (50 + 2500 / 0.24) * (1 - t)],
    ),
    "stops": Path("b/a − 1", 1, 1e-14, lambda t: [_same(4, t), 4 * (1 + t)]),
    "inverse-distortion": Path(
        "1 − r_d/fold", 0.9, 1e-9, lambda t: [_FOLD * (1 - t), _same(-0.2, t), _same(0, t)]
    ),
    "hue": Path("R − B", 0.5, 1e-13, lambda t: [0.5 + t, 0.5 + t / 2, _same(0.5, t)]),
    "normalisation": Path(
        "I/100 − 1", 0.5, 1e-14,
        lambda t: [100 * (1 + t), _same(40, t), _same(160, t), _same(-1, t), _same(1, t)],
    ),
    "pixel": Path(
        "p_x + 0.8", 0.5, 1e-10,
        lambda t: [_same(0.004, t), _same(5e-6, t), np.round(t - 0.8, 12), _same(2, t),
                   _same(320, t)],
    ),
    "weak-perspective": Path("1 − z/zbar", 0.5, 1e-14, lambda t: [10 * (1 - t), _same(10, t)]),
    "snr-loss": Path("N", 10, 1e18, lambda t: [t, _same(5, t)]),
    "poisson": Path("N", 1, 1e12, lambda t: [np.floor(t + np.sqrt(t)), np.floor(t)]),
    "gamma-gap": Path("b − a", 0.8, 1e-8, lambda t: [0.5 - t / 2, 0.5 + t / 2]),
    "vignetting": Path("r/f", 0.5, 1e-8, lambda t: [50 * t, _same(50, t)]),
}  # fmt: skip
"""Family to its path."""


@dataclass(frozen=True)
class Place:
    """One input: where, the right value, and what each way gives with its correct digits."""

    at: float
    right: float
    values: tuple[float, ...]
    digits: tuple[float, ...]


@dataclass(frozen=True)
class Sweep:
    """A family along its path, from easy to hard; ``graded`` and ``level`` are digits needed."""

    symbol: str
    log: bool
    places: tuple[Place, ...]
    graded: float
    level: float

    def lost_from(self, way: str, needed: float) -> float | None:
        """Where a way begins to have fewer digits than needed; None if it never does."""
        index = WAYS.index(way)
        lost = (place.at for place in self.places if place.digits[index] < needed)
        return next(lost, None)


def sweep(family: Family, count: int) -> Sweep:
    """Follow a family along its path."""
    path = PATHS[family.name]
    at = path.places(count)
    columns = [np.asarray(column, dtype=np.float64) for column in path.columns(at)]
    right = truths(family, list(zip(*(column.tolist() for column in columns), strict=True)))
    there = {rung.key: rung for rung in rungs(family, slow=False)}
    found = [_values(there[way], columns) for way in WAYS]
    places = tuple(
        Place(x, r, values, tuple(digits(v, r, family.whole_turn) for v in values))
        for x, r, *values_ in zip(at.tolist(), right, *found, strict=True)
        for values in (tuple(values_),)
    )
    needed = -math.log10(family.tolerance / 2), -math.log10(HALF_LEVEL)
    return Sweep(path.symbol, path.log, places, *needed)


def _values(rung: Rung, columns: Sequence[Column]) -> list[float]:
    """What a way gives for each input: over whole arrays, or one by one if it takes numbers."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        if rung.kind == "scalar":
            rows = zip(*(column.tolist() for column in columns), strict=True)
            return [rung.finish(rung.run(rung.prepare(row))) for row in rows]
        found = rung.run(*[rung.prepare(column) for column in columns])
    filled = np.ma.filled(np.ma.asarray(found, dtype=np.float64), np.nan)
    return [float(value) for value in np.broadcast_to(filled, columns[0].shape)]
