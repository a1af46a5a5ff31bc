"""The fourteen printed formulas once more: for numbers of mpmath, and for those of Python.

Nothing here computes with the code under test; ``m`` is the module that has the functions, ``mpmath``
or ``math``.
"""

# ruff: noqa: N803, N806, ARG005 - letters of the textbook

from __future__ import annotations

import math

import mpmath as mp


def solve_distortion(r_d, k1):
    """The root of r + k1 r^3 = r_d below the fold, by halving."""
    low, high = mp.mpf(0), 1 / mp.sqrt(-3 * k1)
    for _ in range(int(3.4 * mp.mp.dps) + 20):
        middle = (low + high) / 2
        low, high = (middle, high) if middle * (1 + k1 * middle**2) < r_d else (low, middle)
    return low


def undistort_in_five_steps(r_d, k1):
    r = r_d
    for _ in range(5):
        r = r_d / (1 + k1 * r * r)
    return r


def inverse_distortion(m, r_d, k1):
    return (solve_distortion if m is mp else undistort_in_five_steps)(r_d, k1)


def blur_disc(m, f, N, s, z):
    sharp, there = 1 / (1 / f - 1 / s), 1 / (1 / f - 1 / z)
    return f / N * abs(sharp - there) / there


def far_limit(m, f, N, c, s):
    H = f * f / (N * c) + f
    return s * (H - f) / (H - s)


def gamma_gap(m, a, b):
    e = m.mpf(5) / 11 if m is mp else 5 / 11
    return ((a + b) / 2) ** e - (a**e + b**e) / 2


def hue(m, R, G, B):
    most, span = max(R, G, B), max(R, G, B) - min(R, G, B)
    if most == R:
        sector = (G - B) / span
    else:
        sector = 2 + (B - R) / span if most == G else 4 + (R - G) / span
    return 60 * sector % 360


def log2(m, x):
    return m.log(x, 2) if m is mp else m.log2(x)


PRINTED = {
    "thin-lens": lambda m, f, z: 1 / (1 / f - 1 / z),
    "gaussian-tail": lambda m, k: 1 - m.erf(k / m.sqrt(2)),
    "blur-disc": blur_disc,
    "far-limit": far_limit,
    "inverse-distortion": inverse_distortion,
    "snr-loss": lambda m, N, s: 1 - (N / m.sqrt(N + s * s)) / m.sqrt(N),
    "gamma-gap": gamma_gap,
    "vignetting": lambda m, r, f: 1 - (1 / (1 + (r / f) ** 2)) ** 2,
    "stops": lambda m, a, b: 2 * (log2(m, b) - log2(m, a)),
    "hue": hue,
    "normalisation": lambda m, I, low, high, a, b: (I - low) * (b - a) / (high - low) + a,  # noqa: E741
    "pixel": lambda m, f, s, x, z, o: 1 / s * f * (x / z) + o,
    "weak-perspective": lambda m, z, zbar: (1 / z - 1 / zbar) / (1 / z),
    "poisson": lambda m, k, lam: m.exp(
        k * m.log(lam) - lam - (m.loggamma if m is mp else m.lgamma)(k + 1)
    ),
}


def truth(name, row):
    """With a hundred digits; pixels mean the decimals that they print as."""
    with mp.workdps(100):
        read = [mp.mpf(repr(x) if name == "pixel" else x) for x in row]
        return PRINTED[name](mp, *read)


def digits_of(name, value, right):
    """Right decimal digits, at most sixteen; hues on the circle."""
    with mp.workdps(100):
        off, size = abs(mp.mpf(value) - right), abs(right)
        if name == "hue":
            off, size = abs((off + 180) % 360 - 180), mp.mpf(360)
        if off == 0:
            return 16.0
        return float(min(max(-mp.log10(off / size), 0), 16)) if size else 0.0


def printed_digits(name, row):
    """Digits of the formula as printed, computed by Python alone."""
    return digits_of(name, PRINTED[name](math, *row), truth(name, row))
