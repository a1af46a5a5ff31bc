"""Array functions against the textbook formula and other libraries on a million exam inputs.

Run: ``python benchmarks/numerics.py [--worst]``. Prints nanoseconds per value (least of several
runs, the ways taken in turn), first for a million draws of every argument, then for a million
points or pixels of one camera, whose settings are plain numbers. Exits with 1 when a stable
function is slower on draws than allowed: 1.5 times the textbook formula where that is right on
every hard row of ``tests/numerics/rows`` (to 5 units in the last place; both are measured here),
else 3 times, and 20 times for the inverse of the distortion.

``--worst`` prints instead what the slowest element of each function takes: of many rows of zeros,
subnormal and huge numbers, coefficients of every size, counts beyond all doubles. Exits with 1 if
one takes more than 20 microseconds at a machine's best speed.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "arrays"))
from functions import COUNTS, FUNCTIONS

from quizgen.numerics import distortion, gamma, gaussian, hsv, luminosity, projection
from quizgen.tradeoff.lines import fixed_point

COUNT, RUNS = 10**6, 7
HARD = Path(__file__).parents[1] / "tests" / "arrays" / "rows"
ACCURATE = 5.0
"""Units in the last place up to which a textbook formula counts as right."""
ROOT2 = 2**0.5
ODD = (0.0, -0.0, 5e-324, 1e-310, sys.float_info.min, sys.float_info.max, 1e-200, 1e200, 1e-30,
       1e30, 1e-8, 1e8, 1.0, 0.5, 1 / 3, 2.0, 3.0, 37.0, 60.0, 61.0, 1e6, 1e15, 2.0**53, 0.1, 0.02,
       0.8606629658238703, 1 + 2**-52, 1 - 2**-53, 359.9999, 120.0, 447.3, 555.0)  # fmt: skip
"""Edges of the doubles and of formulas; also their opposites."""
FOLDS_THAT_MEET = (0.14593570553834814, -8.903957382502353, 35.67620568123817)
ROWS_OF_ODD, BLOCK, MOST_MICROSECONDS = 300, 1024, 20.0
LOOP, LOOP_THERE = 3_000_000, 0.13
"""Turns of a loop, and the seconds that it takes on the machine of the limit."""


class Case(NamedTuple):
    """One function: textbook, ours, another library if there is one, and the limit.

    ``columns`` holds plain numbers for what one camera has in common; ``rows`` is the name of its
    hard rows.
    """

    name: str
    textbook: Callable[..., Any]
    stable: Callable[..., Any]
    columns: list[Any]
    peer: Callable[..., Any] | None = None
    limit: float = 3.0
    rows: str = ""

    def off(self) -> float:
        """Units in the last place that the textbook formula is off by on the worst hard row."""
        return max((self._off(args, right) for args, right in hard_rows(self.rows)), default=0.0)

    def _off(self, args: list[float], right: mp.mpf) -> float:
        count = len(self.columns)
        if any(args[count:]):  # a quantity that the textbook formula leaves out
            return 0.0
        found = self.textbook(*(np.array([arg, arg]) for arg in args[:count]))
        value = float((found[0] if isinstance(found, tuple) else found)[0])
        return float(abs(value - right) / math.ulp(right)) if math.isfinite(value) else math.inf

    def drawn(self) -> Case:
        """The same with an array for every argument."""
        return self._replace(columns=[np.resize(column, COUNT) for column in self.columns])


def hard_rows(name: str) -> Iterator[tuple[list[float], mp.mpf]]:
    """Arguments and the right value of every hard row of a function that a double can hold."""
    for line in (HARD / f"{name.partition('.')[0]}.tsv").read_text().splitlines():
        row, args, text, *_ = line.split("\t")
        right = mp.mpf(text)
        if row == name and abs(right) < sys.float_info.max:
            yield list(map(float.fromhex, args.split())), right


def cases(rng: np.random.Generator) -> Iterator[Case]:
    """Every array function, on inputs as an exam has them; what is no array is a camera's."""
    unit, other, third = (rng.integers(0, 256, COUNT) / 255 for _ in range(3))
    radius = 0.8606629658238703 * (0.05 + 0.45 * unit)
    yield Case("inverse radius", fixed_point, distortion.inverse_radius, [radius, -0.2],
               opencv_inverse, 20.0, "distortion.inverse_radius")  # fmt: skip
    for name, textbook, stable, columns in (
        (
            "pixel",
            textbook_pixel,
            projection.pixel_coordinate,
            [0.004, 5e-6, unit, 1 + other, 320.0],
        ),
        ("inverse tail", textbook_quantile, gaussian.inverse_upper_tail, [(unit + 0.01) / 2]),
        ("srgb decode", textbook_linear, gamma.srgb_decode, [unit]),
        ("distort", textbook_distort, distortion.distort, [unit, other, -0.2, 0.05]),
        ("to rgb", textbook_rgb, hsv.hsv_to_rgb, [360 * unit, other, third]),
        ("fold radius", textbook_fold, distortion.fold_radius, [-unit - 1]),
        ("V(lambda)", textbook_v, luminosity.luminous_efficiency, [380 + 400 * unit]),
    ):
        peer = scipy_quantile if name == "inverse tail" else None
        yield Case(name, textbook, stable, columns, peer, rows=ROWS.get(name) or named(stable))


ROWS = {"to rgb": "hsv.red", "distort": "distortion.distort_x"}
"""Hard rows are of one result each."""


def named(function: Callable[..., Any]) -> str:
    """What hard rows call a function."""
    return f"{function.__module__.rpartition('.')[2]}.{function.__name__}"


def textbook_fold(k1: Any) -> Any:
    return np.sqrt(-1 / (3 * k1))


def textbook_quantile(p: Any) -> Any:
    import scipy.special

    return ROOT2 * scipy.special.erfcinv(2 * p)


def scipy_quantile(p: Any) -> Any:
    import scipy.special

    return -scipy.special.ndtri(p)


def textbook_pixel(f: Any, pitch: Any, x: Any, z: Any, o: Any) -> Any:
    return o + f * x / (pitch * z)


def textbook_linear(x: Any) -> Any:
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def textbook_rgb(H: Any, S: Any, V: Any) -> Any:
    C = V * S
    X = C * (1 - np.abs(H / 60 % 2 - 1))
    m = V - C
    sector = (H // 60).astype(int) % 6
    zero = np.zeros_like(C)
    R = np.choose(sector, (C, X, zero, zero, X, C)) + m
    G = np.choose(sector, (X, C, C, X, zero, zero)) + m
    return R, G, np.choose(sector, (zero, zero, X, C, C, X)) + m


def textbook_distort(x: Any, y: Any, k1: float, k2: float) -> Any:
    r2 = x * x + y * y
    scale = 1 + k1 * r2 + k2 * r2 * r2
    return x * scale, y * scale


def textbook_v(wavelength: Any) -> Any:
    first, step, values = luminosity.DAY
    return np.interp(wavelength, first + step * np.arange(values.size), values)


def opencv_inverse(r_d: Any, k1: float) -> Any:
    import cv2

    points = np.stack([r_d, np.zeros_like(r_d)], axis=-1)[:, None, :]
    return cv2.undistortPoints(points, np.eye(3), np.array([k1, 0.0, 0.0, 0.0]))


def least(case: Case, *, peer: bool) -> list[float]:
    """Nanoseconds per value of each way, taken in turn so that noise hits all alike."""
    ways = [case.textbook, case.stable, *([case.peer] if case.peer and peer else [])]
    best = [float("inf")] * len(ways)
    with np.errstate(all="ignore"):
        for _ in range(RUNS):
            for i, way in enumerate(ways):
                start = time.perf_counter()
                way(*case.columns)
                best[i] = min(best[i], time.perf_counter() - start)
    return [seconds / COUNT * 1e9 for seconds in best]


def slowness() -> float:
    """How much slower a loop is than where the limit was set."""
    start, total = time.process_time(), 0
    for number in range(LOOP):
        total += number * number
    return (time.process_time() - start) / LOOP_THERE


def odd_rows(rng: np.random.Generator, count: int) -> Iterator[list[Any]]:
    """Arguments of which all but the last element of a block are the same odd ones."""
    if count == len(FOLDS_THAT_MEET):
        yield [np.full(BLOCK, x) for x in FOLDS_THAT_MEET]
    for _ in range(ROWS_OF_ODD):
        row = rng.choice(ODD, count) * rng.choice([1.0, 1.0, -1.0], count)
        row = row * (1 + rng.integers(-3, 4, count) * 2.0**-40)
        yield [np.append(np.full(BLOCK - 1, x), np.nextafter(x, 2.0)) for x in row]


def microseconds(call: Callable[..., Any], columns: list[Any]) -> float:
    """Of each element of a block, at the better of two tries."""
    best = float("inf")
    for _ in range(2):
        start = time.process_time()
        call(*columns)
        best = min(best, time.process_time() - start)
    return best / BLOCK * 1e6


def worst() -> int:
    """Print what the slowest element of each function takes; 1 if it is too much."""
    rng, over = np.random.default_rng(1), False
    print(f"{'function':26} {'us':>6}  arguments")
    for name, call in FUNCTIONS.items():
        before = slowness()
        with np.errstate(all="ignore"):
            timed = [
                (microseconds(call, columns), [float(column[0]) for column in columns])
                for columns in odd_rows(rng, COUNTS.get(name, 1))
            ]
        longest, row = max(timed)
        longest /= (before + slowness()) / 2
        over = over or longest > MOST_MICROSECONDS
        print(f"{name:26} {longest:6.1f}  {', '.join(f'{x:.4g}' for x in row)}")
    return int(over)


def main() -> int:
    rng = np.random.default_rng(1)
    slow = []
    print(f"{'':20} {'a million draws':^25} {'one camera':^25}")
    timed = f"{'textbook':>9} {'stable':>8} {'ratio':>6}"
    print(f"{'function':20} {timed} {timed} {'off':>8} {'limit':>6} {'peer':>8}")
    for case in cases(rng):
        drawn = least(case.drawn(), peer=False)
        camera = least(case, peer=True)
        shown = [f"{t:9.2f} {s:8.2f} {s / t:6.2f}" for t, s in (drawn, camera[:2])]
        peer = f"{camera[2]:8.1f}" if case.peer else ""
        with np.errstate(all="ignore"):
            off = case.off()
        limit = 1.5 if off <= ACCURATE else case.limit
        print(f"{case.name:20} {' '.join(shown)} {off:8.2g} {limit:6.1f} {peer}".rstrip())
        if drawn[1] > limit * drawn[0]:
            slow.append(case.name)
    if slow:
        print("slower than allowed: " + ", ".join(slow))
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(worst() if sys.argv[1:] == ["--worst"] else main())
