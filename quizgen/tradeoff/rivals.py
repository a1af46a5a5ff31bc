"""Arrays of numbers: the house's functions, plain lines and other libraries, each warm.

Every way gets its input as its user holds it (points for OpenCV, a picture for colours) and is
called as its user would write it.
"""

from __future__ import annotations

import statistics
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from quizgen.numerics.distortion import inverse_radius
from quizgen.tradeoff import lines
from quizgen.tradeoff.formulas import BY_NAME, Columns
from quizgen.tradeoff.lines import Column
from quizgen.tradeoff.sweeps import EXAMS, PLACES, SEED
from quizgen.tradeoff.truth import correct_digits, truths


@dataclass(frozen=True)
class Timing:
    """Seconds of several runs: the least, which is nearest to the work itself, and the median."""

    least: float
    median: float

    def per(self, count: float) -> Timing:
        """Return the timing of one of ``count`` equal pieces of work."""
        return Timing(self.least / count, self.median / count)


def in_turns(calls: Sequence[Callable[[], Any]], runs: int) -> list[Timing]:
    """Return the timing of each call, all called in turn ``runs`` times after a warm-up."""
    spent: list[list[float]] = [[] for _ in calls]
    for turn in range(runs + 1):
        for call, seconds in zip(calls, spent, strict=True):
            start = time.perf_counter()
            call()
            if turn:
                seconds.append(time.perf_counter() - start)
    return [Timing(min(seconds), statistics.median(seconds)) for seconds in spent]


ARRAY = 100_000
"""Elements of a timed array."""
_RUNS = 9

Call = Callable[[], Any]
"""A call whose input is at hand."""
Ready = Callable[..., Call]
"""Columns to such a call."""


@dataclass(frozen=True)
class Rival:
    """One way to compute a formula: seconds a value, worst digits on exam and hard inputs."""

    name: str
    time: Timing
    exam: float
    hard: float


@dataclass(frozen=True)
class Match:
    """All ways to compute one formula, that of the printed formula first."""

    formula: str
    rivals: tuple[Rival, ...]


def _prepare_plain_call(call: Callable[..., Any]) -> Ready:
    """Return a function from columns to a call on them, without preparation."""
    return lambda *columns: partial(call, *columns)


def _iter_undistortion_rivals() -> Iterator[tuple[str, Ready]]:
    """Yield name and preparation of each way to undo lens distortion."""
    yield "fixed-point", _prepare_plain_call(lines.fixed_point)
    yield "newton", _prepare_plain_call(lines.newton)
    yield "quizgen", lambda r, k: partial(inverse_radius, r, k[0])
    import cv2

    def opencv(r: Column, k: Column) -> Call:
        """Return OpenCV's call."""
        points = np.stack([r, np.zeros_like(r)], axis=-1)[:, None, :]
        lens = np.array([k[0], 0.0, 0.0, 0.0])
        return lambda: cv2.undistortPoints(points, np.eye(3), lens)[:, 0, 0]

    yield "OpenCV undistortPoints", opencv


def _stack_channels(*rgb: Column) -> Column:
    """Return R, G and B as a picture of one row, shape (1, N, 3)."""
    return np.stack(rgb, axis=-1)[None]


def _iter_hue_rivals() -> Iterator[tuple[str, Ready]]:
    """Yield name and preparation of each way to compute a hue."""
    yield "printed", _prepare_plain_call(lines.hue)
    from matplotlib.colors import rgb_to_hsv

    def matplotlib(*rgb: Column) -> Call:
        """Return matplotlib's call."""
        picture = _stack_channels(*rgb)
        return lambda: 360 * rgb_to_hsv(picture)[0, :, 0]

    yield "matplotlib rgb_to_hsv", matplotlib
    import cv2

    def opencv(*rgb: Column) -> Call:
        """Return OpenCV's call."""
        picture = _stack_channels(*rgb).astype(np.float32)
        return lambda: cv2.cvtColor(picture, cv2.COLOR_RGB2HSV)[0, :, 0]

    yield "OpenCV cvtColor, float32", opencv


def _iter_falloff_rivals() -> Iterator[tuple[str, Ready]]:
    """Yield name and preparation of each way to compute the fall-off of light."""
    yield "printed", _prepare_plain_call(lambda r, f: 1 - (1 / (1 + (r / f) ** 2)) ** 2)
    yield "line", _prepare_plain_call(lines.falloff)


def _iter_tail_rivals() -> Iterator[tuple[str, Ready]]:
    """Yield name and preparation of each way to compute a Gaussian tail."""
    from scipy import special

    yield "printed", _prepare_plain_call(lambda k: 1 - special.erf(k / 2**0.5))
    yield "SciPy erfc", _prepare_plain_call(lambda k: special.erfc(k / 2**0.5))


_MATCHES = {
    "inverse-distortion": _iter_undistortion_rivals,
    "hue": _iter_hue_rivals,
    "vignetting": _iter_falloff_rivals,
    "gaussian-tail": _iter_tail_rivals,
}


def matches() -> list[Match]:
    """Return the measured ways of every formula that is computed on arrays."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        found = [
            _measure_match(name, list(_iter_installed(ways()))) for name, ways in _MATCHES.items()
        ]
    return [match for match in found if len(match.rivals) > 1]


def _iter_installed(ways: Iterator[tuple[str, Ready]]) -> Iterator[tuple[str, Ready]]:
    """Yield the ways up to the first whose library is not installed."""
    with suppress(ImportError):
        yield from ways


def _measure_match(name: str, ways: list[tuple[str, Ready]]) -> Match:
    """Return times and digits of all ways to compute one formula."""
    formula = BY_NAME[name]
    exam = formula.exam(np.random.default_rng(SEED), EXAMS)
    hard = formula.path(formula.places(PLACES))
    long = [np.resize(column, ARRAY) for column in exam]
    times = in_turns([ready(*long) for _, ready in ways], _RUNS)
    rivals = tuple(
        Rival(
            way,
            time.per(ARRAY),
            _find_fewest_digits(name, ready, exam),
            _find_fewest_digits(name, ready, hard),
        )
        for (way, ready), time in zip(ways, times, strict=True)
    )
    return Match(name, rivals)


def _find_fewest_digits(name: str, ready: Ready, columns: Columns) -> float:
    """Return the fewest right digits that a way gives on some inputs."""
    formula = BY_NAME[name]
    found = np.ma.filled(ready(*columns)(), np.nan)
    right = truths(formula, columns)
    return min(
        correct_digits(float(value), truth, formula.turn)
        for value, truth in zip(found, right.tolist(), strict=True)
    )
