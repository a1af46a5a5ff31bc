"""Photographs against each other: what effects really change, and how long they really take."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from statistics import median
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.pixels.codes import GREY_LEVELS, to_8bit
from quizgen.camera.planner import PreparedScene
from quizgen.camera.setup.scene import Image
from quizgen.camera.simulation import Photo, measure_difference, run_plan

Codes = NDArray[np.uint8]

_GAP = 8
_SCALES = 1000, 500, 200, 100, 50, 20, 10, 5, 2, 1


def amplify_difference(one: Image, other: Image) -> tuple[int, Codes]:
    """Return the absolute difference of two pictures, amplified so that it can be seen.

    The factor is 1, 2, 5, 10, ...: of the values that differ by a grey level (or of all, where none
    does) 98 % are not clipped.

    Returns
    -------
    int
        The factor.
    numpy.ndarray
        8-bit codes; black where the pictures agree.
    """
    apart = np.abs(np.clip(one, 0.0, 1.0) - np.clip(other, 0.0, 1.0))
    there = apart[apart >= 1.0 / GREY_LEVELS]
    bright = float(np.quantile(there if there.size else apart, 0.98))
    scale = next((scale for scale in _SCALES if scale * bright <= 1.0), 1)
    return scale, to_8bit(apart * (scale * GREY_LEVELS))


def concatenate_pictures(*pictures: Codes) -> Codes:
    """Return pictures of one height in a row, with white between them."""
    gap = np.full((pictures[0].shape[0], _GAP, 3), 255, np.uint8)
    parts = [part for picture in pictures for part in (picture, gap)]
    return np.concatenate(parts[:-1], axis=1)


def measure_effects(
    prepared: PreparedScene, photo: Photo, names: Collection[str], on_effect: Callable[[str], None]
) -> dict[str, float]:
    """Return the largest change, in grey levels, that each present effect makes to the picture.

    Parameters
    ----------
    prepared : PreparedScene
    photo : Photo
        Taken with the effects of these names.
    names : collection of str
    on_effect : callable
        Gets the name of each effect before it is tried.
    """
    units = (prepared.find_unit(one) for one in prepared.present if one.prepare is None)
    found: dict[str, float] = {}
    for members in dict.fromkeys(units):
        on_effect(min(members))
        other = run_plan(prepared, set(names) ^ set(members))
        found.update(dict.fromkeys(members, measure_difference(photo, other)))
    return found


@dataclass(frozen=True)
class Race:
    """Times of two sets of effects on one scene, measured in turns, both warm.

    Parameters
    ----------
    first_ms, second_ms : tuple of float
        From the shortest to the longest.
    """

    first_ms: tuple[float, ...]
    second_ms: tuple[float, ...]

    @property
    def medians(self) -> tuple[float, float]:
        """The median time of each, ms."""
        return median(self.first_ms), median(self.second_ms)

    @property
    def saves(self) -> bool:
        """Whether the first takes 5 % less time, and in most turns less than most of the second."""
        first, second = self.medians
        few = len(self.second_ms) // 4
        return first < 0.95 * second and self.first_ms[-1 - few] < self.second_ms[few]


TURNS = 5
_LONGEST = 6.0
"""Seconds after which three turns are enough."""


def time_in_turns(prepared: PreparedScene, first: Collection[str], second: Collection[str]) -> Race:
    """Return the times of two sets of effects, run in turns `TURNS` times after a warm-up.

    Parameters
    ----------
    prepared : PreparedScene
    first, second : collection of str
        Names of effects.
    """
    times: tuple[list[float], list[float]] = [], []
    began = perf_counter()
    for turn in range(TURNS + 1):
        order = (0, 1) if turn % 2 else (1, 0)  # none always follows the other
        for which in order:
            started = perf_counter()
            run_plan(prepared, (first, second)[which])
            times[which].append((perf_counter() - started) * 1e3)
        if turn >= 3 and perf_counter() - began > _LONGEST:
            break
    return Race(tuple(sorted(times[0][1:])), tuple(sorted(times[1][1:])))
