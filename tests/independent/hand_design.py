"""Designs under constraints: a setting is searched that meets what the page demands."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator
from typing import Any

from by_hand import solves
from printed_page import Page

THIRD = 2 ** (1 / 3)
STOPS = [2, 2.8, 4, 5.6, 8, 11, 16]
TIMES = [60, 125, 250, 500, 1000, 1250, 1600, 2000, 2500, 3200, 4000]
GAINS = [100, 200, 400, 800, 1000, 1600, 3200, 4000, 5000, 6400, 12800]


def disc(f: float, n: float, s: float, z: float) -> float:
    """Blur disc by the thin lens, F33: where the sensor is, and where the point would be sharp."""
    sensor, sharp = 1 / (1 / f - 1 / s), 1 / (1 / f - 1 / z)
    return f / n * abs(sensor - sharp) / sharp


def right_exposure(n: float, t: float, iso: float, given: tuple[float, float, float]) -> bool:
    """Whether t ISO / N² is that of a setting, within a third of a stop."""
    n_0, t_0, iso_0 = given
    ratio = (t * iso / n**2) / (t_0 * iso_0 / n_0**2)
    return 1 / THIRD <= ratio <= THIRD


def first(found: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """The setting in the middle of those that do."""
    feasible = list(found)
    assert feasible, "no setting meets the demands"
    return feasible[len(feasible) // 2]


@solves("design-number-plate-camera")
def plates(page: Page) -> dict[str, Any]:
    """Notes 4.1, 4.8: sizes on the sensor are f/z of those outside."""
    width = next(float(v) for v in page.amounts("px") if v in {90, 100})
    lane = next(float(v) for v in page.amounts("m") if 2 < v < 5)
    speed = float(page.amounts("m/s")[0])
    blur = next(float(v) for v in page.amounts("px") if v in {2, 3})
    px = 5e-6

    def found() -> Iterator[dict[str, Any]]:
        for f, n, t, iso, s in itertools.product((0.028, 0.035, 0.04, 0.05, 0.055, 0.085), STOPS,
                                                 TIMES, GAINS, (22, 25, 27, 30)):  # fmt: skip
            if (f * 0.52 / 40 >= width * px and f * lane / 20 <= 0.01024 and iso <= 1600
                    and f * speed / t / 20 <= blur * px
                    and max(disc(f, n, s, 20), disc(f, n, s, 40)) <= px
                    and right_exposure(n, 1 / t, iso, (8, 1 / 250, 100))):  # fmt: skip
                yield {"f": f * 1000, "N": n, "t": 1 / t, "ISO": iso, "d": s}

    return {"a": first(found())}


@solves("design-settings-for-hall-sport")
def hall(page: Page) -> dict[str, Any]:
    """Notes 4.8, F33 to F35."""
    far, deep = (float(v) for v in page.amounts("m"))
    (speed,), blur = map(float, page.amounts("m/s")), float(page.amounts("px")[0])
    most, px, f = float(page.amounts("")[-1]), 6e-6, 0.085

    def found() -> Iterator[dict[str, Any]]:
        for n, t, iso in itertools.product((1.4, 1.8, 2, 2.8, 4, 5.6), TIMES, GAINS):
            if (f * speed / t / far <= blur * px and disc(f, n, far, far - deep / 2) <= 4 * px
                    and iso <= most and right_exposure(n, 1 / t, iso, (4, 1 / 60, 800))):  # fmt: skip
                yield {"N": n, "t": 1 / t, "ISO": iso}

    return {"a": first(found())}


@solves("design-book-scanner")
def scanner(page: Page) -> dict[str, Any]:
    """F42 and the Airy disc: the magnification is z'/z."""
    lengths = [float(v) for v in page.amounts("mm")]
    wide, high = lengths[:2]
    curl = next(v for v in lengths if v in {0.008, 0.01})
    room = next(v for v in lengths if v in {0.6, 0.65})
    per_inch = next(float(v) for v in page.amounts("") if v in {250, 300})
    px = 3.9e-6

    def found() -> Iterator[dict[str, Any]]:
        for f, z, n in itertools.product((0.018, 0.024, 0.028, 0.035, 0.05),
                                         (0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6), STOPS):  # fmt: skip
            m = 1 / (1 / f - 1 / z) / z
            if (m * wide <= 6000 * px and m * high <= 4000 * px and z <= room
                    and m * 0.0254 / px >= per_inch and disc(f, n, z, z - curl) <= 1.5 * px
                    and 2.44 * 550e-9 * n * (1 + m) <= 3 * px):  # fmt: skip
                yield {"f": f * 1000, "z": z * 1000, "N": n}

    return {"a": first(found())}


@solves("design-frames-of-a-nebula")
def nebula(page: Page) -> dict[str, Any]:
    """F45 and notes 2.13: the variances of all frames add."""
    light, dark, read, star, full, *_ = (float(v) for v in page.amounts(""))
    snr = float(page.amounts("")[5])

    def found() -> Iterator[dict[str, Any]]:
        for t, n in itertools.product(range(1, 16), range(1, 60)):
            electrons, variance = n * light * t, n * ((light + dark) * t + read**2)
            if (star * t <= full and t <= 8 and n * (t + 2) <= 60
                    and electrons / math.sqrt(variance) >= snr):  # fmt: skip
                yield {"t": t, "n": n}

    return {"a": first(found())}
