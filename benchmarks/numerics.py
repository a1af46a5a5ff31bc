"""Array functions against the textbook formula and other libraries on a million exam inputs.

Run: ``python benchmarks/numerics.py``. Prints nanoseconds per value (least of several runs, the
ways taken in turn), first for a million draws of every argument, then for a million points or
pixels of one camera, whose settings are plain numbers. Exits with 1 when a stable function is
slower on draws than allowed: 3 times the textbook formula, 20 times for the inverse of the
distortion.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from quizgen.arrays import (
    cie1924,
    depth_of_field,
    distortion,
    gamma,
    gaussian,
    hsv,
    luminosity,
    projection,
    snr,
    statistics,
    stops,
    thin_lens,
    vignetting,
)
from quizgen.tradeoff.families import BY_NAME
from quizgen.tradeoff.ladder import rungs

COUNT, RUNS = 10**6, 7
ROOT2, GAMMA = 2**0.5, 2.2


class Case(NamedTuple):
    """One function: textbook, ours, another library if there is one, and the limit.

    ``columns`` holds plain numbers for what one camera has in common.
    """

    name: str
    textbook: Callable[..., Any]
    stable: Callable[..., Any]
    columns: list[Any]
    peer: Callable[..., Any] | None = None
    limit: float = 3.0

    def drawn(self) -> Case:
        """The same with an array for every argument."""
        return self._replace(columns=[np.resize(column, COUNT) for column in self.columns])


def from_families(rng: np.random.Generator) -> Iterator[Case]:
    """Families of the accuracy page: their chain in float64 is the textbook formula."""
    for name, fixed in SCALARS.items():
        family = BY_NAME[name]
        columns = [np.resize(column, COUNT) for column in family.exam(rng, 4096)]
        for i in fixed:
            columns[i] = columns[i][0]
        textbook = next(r for r in rungs(family) if r.key == "float64").run
        limit = 20.0 if name == "inverse-distortion" else 3.0
        yield Case(name, textbook, family.stable, columns, PEERS.get(name), limit)


SCALARS = {
    "gaussian-tail": (), "thin-lens": (0,), "blur-disc": (0, 1, 2), "far-limit": (2,),
    "stops": (), "inverse-distortion": (1, 2), "hue": (), "normalisation": (1, 2, 3, 4),
    "pixel": (0, 1, 4), "weak-perspective": (1,), "snr-loss": (1,), "poisson": (),
    "gamma-gap": (), "vignetting": (1,),
}  # fmt: skip
"""Arguments that are one number for a whole picture."""


def others(rng: np.random.Generator) -> Iterator[Case]:
    """Functions that have no page of their own."""
    k = rng.integers(0, 13, COUNT) / 4
    unit, other, third = (rng.integers(0, 256, COUNT) / 255 for _ in range(3))
    s = 100.0 * rng.integers(5, 60, COUNT)
    yield Case("pdf", textbook_pdf, gaussian.pdf, [k, 0.5, 1.5])
    yield Case("upper tail", textbook_tail, gaussian.upper_tail, [k], peer_tail)
    yield Case("near limit", textbook_near, depth_of_field.near_limit, [50.0, 8.0, 0.03, s])
    yield Case("total depth", textbook_total, depth_of_field.total_depth, [50.0, 8.0, 0.03, s])
    yield Case("magnification", textbook_magnification, thin_lens.magnification, [50.0, s])
    yield Case("light ratio", lambda a, b: (b / a) ** 2, stops.light_ratio, [2.0, k + 1])
    yield Case("snr", lambda N, r: N / np.sqrt(N + r**2), snr.snr, [s, 5.0])
    yield Case("encode", lambda x: x ** (1 / GAMMA), gamma.encode, [unit])
    yield Case("decode", lambda x: x**GAMMA, gamma.decode, [unit])
    yield Case("srgb encode", textbook_srgb, gamma.srgb_encode, [unit])
    yield Case("srgb decode", textbook_linear, gamma.srgb_decode, [unit])
    yield Case("cos4", lambda r, f: 1 / (1 + (r / f) ** 2) ** 2, vignetting.cos4, [k * 8, 50.0])
    yield Case("saturation", textbook_saturation, hsv.saturation, [unit, other, third])
    yield Case("to rgb", textbook_rgb, hsv.to_rgb, [360 * unit, other, third])
    yield Case("distort", textbook_distort, distortion.distort, [unit, other, -0.2, 0.05])
    yield Case("project", textbook_project, projection.project, [2.0, unit, other, s])
    yield Case("V(lambda)", textbook_v, luminosity.photopic, [380 + 400 * unit])


def more(rng: np.random.Generator) -> Iterator[Case]:
    """Further functions of the same families."""
    k, s = rng.integers(0, 13, COUNT) / 4, 100.0 * rng.integers(5, 60, COUNT)
    unit, nm = rng.integers(1, 256, COUNT) / 255, 1.0 * rng.integers(380, 781, COUNT)
    yield Case("log tail", lambda k: np.log(textbook_tail(k)), gaussian.log_tail, [k])
    yield Case("inverse tail", textbook_quantile, gaussian.inverse_tail, [unit / 2])
    yield Case("interval", textbook_interval, gaussian.interval, [k, k + 1])
    yield Case("expected pixels", textbook_expected, gaussian.expected_beyond, [1e6, k])
    yield Case(
        "hyperfocal",
        lambda f, N, c: f * f / (N * c) + f,
        depth_of_field.hyperfocal,
        [50.0, k + 1, 0.03],
    )
    yield Case(
        "focus shift", lambda f, z: 1 / (1 / f - 1 / z) - f, thin_lens.focus_shift, [50.0, s]
    )
    yield Case("photons for snr", textbook_photons, snr.photons_for, [k + 1, 5.0])
    yield Case("displacement", textbook_shift, distortion.displacement, [unit, -0.2, 0.05])
    yield Case("fold radius", lambda k1: np.sqrt(-1 / (3 * k1)), distortion.fold_radius, [-unit])
    yield Case("photon energy", lambda nm: 1239.841984 / nm, luminosity.photon_energy_ev, [nm])
    yield Case("mean", lambda image: image.sum() / image.size, statistics.mean, [s])
    yield Case("variance", textbook_variance, statistics.variance, [s])


def textbook_quantile(p: Any) -> Any:
    import scipy.special

    return ROOT2 * scipy.special.erfcinv(2 * p)


def textbook_interval(a: Any, b: Any) -> Any:
    import scipy.special

    return (scipy.special.erf(b / ROOT2) - scipy.special.erf(a / ROOT2)) / 2


def textbook_expected(M: Any, k: Any) -> Any:
    return 2 * M * textbook_tail(k)


def textbook_photons(S: Any, r: Any) -> Any:
    return (S * S + S * np.sqrt(S * S + 4 * r * r)) / 2


def textbook_shift(r: Any, k1: Any, k2: Any) -> Any:
    return r - r * (1 + k1 * r**2 + k2 * r**4)


def textbook_variance(image: Any) -> Any:
    return ((image - image.mean()) ** 2).sum() / (image.size - 1)


def textbook_pdf(x: Any, mu: float, sigma: float) -> Any:
    return np.exp(-((x - mu) ** 2) / (2 * sigma**2)) / (np.sqrt(2 * np.pi) * sigma)


def textbook_magnification(f: float, z: Any) -> Any:
    return (1 / (1 / f - 1 / z)) / z


def textbook_tail(k: Any) -> Any:
    import scipy.special

    return 1 - (1 + scipy.special.erf(k / ROOT2)) / 2


def peer_tail(k: Any) -> Any:
    import scipy.special

    return scipy.special.ndtr(-k)


def textbook_near(f: float, N: float, c: float, s: Any) -> Any:
    H = f**2 / (N * c) + f
    return s * (H - f) / (H + s - 2 * f)


def textbook_total(f: float, N: float, c: float, s: Any) -> Any:
    H = f**2 / (N * c) + f
    return np.where(s < H, s * (H - f) / (H - s), np.inf) - textbook_near(f, N, c, s)


def textbook_srgb(x: Any) -> Any:
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def textbook_linear(x: Any) -> Any:
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def textbook_saturation(R: Any, G: Any, B: Any) -> Any:
    top = np.maximum(np.maximum(R, G), B)
    spread = top - np.minimum(np.minimum(R, G), B)
    return np.where(top == 0, 0.0, spread / np.where(top == 0, 1.0, top))


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


def textbook_project(f: float, x: Any, y: Any, z: Any) -> Any:
    return f * x / z, f * y / z


def textbook_v(wavelength: Any) -> Any:
    at = cie1924.FIRST_NM + cie1924.STEP_NM * np.arange(len(cie1924.V))
    return np.interp(wavelength, at, cie1924.V)


def opencv_inverse(r_d: Any, k1: float, k2: float) -> Any:
    import cv2

    points = np.stack([r_d, np.zeros_like(r_d)], axis=-1)[:, None, :]
    return cv2.undistortPoints(points, np.eye(3), np.array([k1, k2, 0.0, 0.0]))


def opencv_hue(R: Any, G: Any, B: Any) -> Any:
    import cv2

    picture = np.stack([R, G, B], axis=-1)[None].astype(np.float32)
    return cv2.cvtColor(picture, cv2.COLOR_RGB2HSV)


def scipy_two_sided(k: Any) -> Any:
    import scipy.special

    return scipy.special.erfc(k / ROOT2)


PEERS = {
    "gaussian-tail": scipy_two_sided,
    "inverse-distortion": opencv_inverse,
    "hue": opencv_hue,
}


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


def main() -> int:
    rng = np.random.default_rng(1)
    slow = []
    print(f"{'':20} {'a million draws':^25} {'one camera':^25}")
    timed = f"{'textbook':>9} {'stable':>8} {'ratio':>6}"
    print(f"{'function':20} {timed} {timed} {'limit':>6} {'peer':>8}")
    for case in (*from_families(rng), *others(rng), *more(rng)):
        drawn = least(case.drawn(), peer=False)
        camera = least(case, peer=True)
        shown = [f"{t:9.2f} {s:8.2f} {s / t:6.2f}" for t, s in (drawn, camera[:2])]
        peer = f"{camera[2]:8.1f}" if case.peer else ""
        print(f"{case.name:20} {' '.join(shown)} {case.limit:6.0f} {peer}".rstrip())
        if drawn[1] > case.limit * drawn[0]:
            slow.append(case.name)
    if slow:
        print("slower than allowed: " + ", ".join(slow))
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
