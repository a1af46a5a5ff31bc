"""Work-precision ladders: what each setting of a tunable approximation costs and buys."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from quizgen.arrays import distortion, gaussian, luminosity, poisson
from quizgen.arrays.double_double import Double
from quizgen.tradeoff import plain
from quizgen.tradeoff.measure import Effort, timed
from quizgen.tradeoff.photographs import photographs
from quizgen.tradeoff.plot import power_text
from quizgen.tradeoff.rung import Column
from quizgen.tradeoff.special import fixed_point
from quizgen.tradeoff.work import Curve, Point


@dataclass(frozen=True)
class Knob:
    """A tunable approximation."""

    key: str
    measure: Callable[[Effort], Iterator[Curve]]


def _iterations(effort: Effort) -> Iterator[Curve]:
    """Fixed-point steps of inverse distortion against the closed form."""
    k1 = -0.2
    fold = float(distortion.fold_radius(k1))
    largest = fold * (1 + k1 * fold * fold)
    for share in (0.5, 0.9, 0.99):
        radii = np.full(4096, share * largest)
        right = float(distortion.inverse_radius(share * largest, k1))
        points = []
        for count in (1, 2, 5, 10, 20, 50, 100, 200):
            value = float(fixed_point(radii, k1, count)[0])
            work = partial(fixed_point, radii, k1, count)
            spent = timed(work, effort.repeats)
            points.append(Point(str(count), spent, abs(value / right - 1)))
        closed = partial(distortion.inverse_radius, radii, k1)
        spent = timed(closed, effort.repeats)
        value = float(distortion.inverse_radius(radii, k1)[0])
        yield Curve(f"{share:g}", (*points, Point("=", spent, abs(value / right - 1))))


def _kernel(effort: Effort) -> Iterator[Curve]:
    """Gaussian kernel cut off at t sigma and renormalised, on a full-contrast edge."""
    tail = gaussian.upper_tail
    sigma, row = 8.0, np.repeat([0.0, 255.0], 2048)
    x = np.linspace(0, 6, 2001)
    for_edge = np.asarray(tail(-x))
    points = []
    for t in (1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0):
        inside = 1 - 2 * tail(t)
        cut = np.minimum((for_edge - tail(t)) / inside, 1.0)
        reach = int(t * sigma)
        taps = np.exp(-(np.arange(-reach, reach + 1) ** 2) / (2 * sigma**2))
        spent = timed(partial(np.convolve, row, taps, "same"), effort.repeats)
        points.append(Point(f"{t:g}", spent, float(255 * np.max(np.abs(cut - for_edge)))))
    yield Curve("sigma = 8", tuple(points))


def coverage(a: Double, b: Double, c: Double) -> Double:
    """Area of the unit square with a x + b y < c, for a, b > 0."""

    def half(value: Double) -> Double:
        return np.maximum(value, 0.0) ** 2

    return (half(c) - half(c - a) - half(c - b) + half(c - a - b)) / (2 * a * b)


def _supersampling(effort: Effort) -> Iterator[Curve]:
    """Samples in an n x n grid per pixel against the exact area under random edges."""
    rng = np.random.default_rng(3)
    angle = rng.uniform(0.05, 1.5, 400)
    a, b = np.cos(angle), np.sin(angle)
    c = rng.uniform(0, 1, 400) * (a + b)
    right = coverage(a, b, c)

    def sampled(n: int) -> Column:
        at = (np.arange(n) + 0.5) / n
        inside = a[:, None, None] * at[:, None] + b[:, None, None] * at < c[:, None, None]
        return inside.mean(axis=(1, 2))

    points = []
    for n in (1, 2, 4, 8, 16, 32):
        spent = timed(partial(sampled, n), effort.repeats)
        error = 255 * float(np.max(np.abs(sampled(n) - right)))
        points.append(Point(f"{n}x{n}", spent, error))
    spent = timed(lambda: coverage(a, b, c), effort.repeats)
    points.append(Point("=", spent, 0.0))
    yield Curve("n x n", tuple(points))


def _layers(effort: Effort) -> Iterator[Curve]:
    """Depth slices for a blurred picture: largest error of the blur disc in pixels."""
    (f, N, s), pitch = np.array([50.0, 1.8, 3000.0]), 0.005
    depth = 1 / np.linspace(1 / 1000, 1 / 50000, 4001)
    picture = np.random.default_rng(1).random((128, 128))

    def signed(z: Column) -> Column:
        disc: Column = plain.blur_disc(f, N, s, z) * np.sign(z - s) / pitch
        return disc

    def slices(count: int) -> None:
        for _ in range(count):
            one_pass()

    def one_pass() -> Column:
        total = np.cumsum(np.cumsum(picture, axis=0), axis=1)
        return total[15:, 15:] - total[:-15, 15:] - total[15:, :-15] + total[:-15, :-15]

    counts = (2, 4, 8, 16, 32, 64)
    spent = {count: timed(partial(slices, count), effort.repeats) for count in counts}
    maps: dict[str, Callable[[Column], Column]] = {"1/z": np.reciprocal, "z": np.positive}
    for label, of in maps.items():
        points = []
        for count in counts:
            position = of(depth)
            low, width = position.min(), np.ptp(position) / count
            index = np.minimum((position - low) // width, count - 1)
            middle = of(low + (index + 0.5) * width)
            error = float(np.max(np.abs(signed(middle) - signed(depth))))
            points.append(Point(str(count), spent[count], error))
        yield Curve(label, tuple(points))


def _photons(effort: Effort) -> Iterator[Curve]:
    """Normal instead of Poisson numbers: largest difference of the distribution functions."""
    lower = poisson.lower
    tail = gaussian.upper_tail
    rng = np.random.default_rng(5)
    exact, normal = [], []
    for N in (1.0, 10.0, 100.0, 1e3, 1e4, 1e6):
        k = np.unique(np.floor(np.maximum(N + np.sqrt(N) * np.linspace(-6, 6, 401), 0)))
        error = np.max(np.abs(np.asarray(lower(k, N)) - tail(-(k - N) / np.sqrt(N))))
        spent = timed(partial(rng.poisson, N, 4096), effort.repeats)
        exact.append(Point(f"N = {power_text(N)}", spent, 0.0))
        spent = timed(partial(rng.normal, N, N**0.5, 4096), effort.repeats)
        normal.append(Point(f"N = {power_text(N)}", spent, float(error)))
    yield Curve("normal", tuple(normal))
    yield Curve("Poisson", tuple(exact))


_KM = 683.0
"""Lumens per watt at the peak."""


def _line_flux(centre: float, sigma: float) -> float:
    """Closed form on each straight piece of V(lambda)."""
    curve = luminosity.DAY
    at = (curve.first + curve.step * np.arange(curve.values.size) - centre) / sigma
    slope = np.diff(curve.values) / curve.step
    tail, bell = np.asarray(gaussian.upper_tail(at)), np.exp(-(at**2) / 2) / (2 * np.pi) ** 0.5
    at_centre = curve.values[:-1] - slope * sigma * at[:-1]
    return _KM * float(np.sum(at_centre * -np.diff(tail) - slope * sigma * np.diff(bell)))


def _wavelengths(effort: Effort) -> Iterator[Curve]:
    """Riemann sums over V(lambda) against the closed form, for lines of two widths."""
    centre = 532.4
    for fwhm in (20.0, 1.0):
        sigma = fwhm / 2.3548200450309493
        right = _line_flux(centre, sigma)
        points = []
        for step in (10.0, 5.0, 1.0, 0.1):

            def total(step: float = step, sigma: float = sigma) -> float:
                at = np.arange(360.0, 830.0, step)
                line = np.exp(-(((at - centre) / sigma) ** 2) / 2) / (sigma * (2 * np.pi) ** 0.5)
                return float(_KM * step * np.sum(line * np.asarray(luminosity.efficiency(at))))

            spent = timed(total, effort.repeats)
            points.append(Point(f"{step:g} nm", spent, abs(total() / right - 1)))
        spent = timed(partial(_line_flux, centre, sigma), effort.repeats)
        yield Curve(f"{fwhm:g} nm", (*points, Point("=", spent, 0.0)))


KNOBS = (
    Knob("camera", photographs),
    Knob("iterations", _iterations),
    Knob("kernel", _kernel),
    Knob("supersampling", _supersampling),
    Knob("layers", _layers),
    Knob("photons", _photons),
    Knob("wavelengths", _wavelengths),
)
"""Every tunable approximation; error units stand with the words."""
