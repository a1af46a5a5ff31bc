"""Inputs aimed at poles, folds, ties, cancellation, overflow and subnormals, with their origin.

Each generator yields ``(function, args, origin)``. No value here depends on the code under test.
Those of lenses and cameras stand in ``hard_optics``.
"""

# ruff: noqa: N806, C901 - mathematics and tables of inputs

from __future__ import annotations

from itertools import product

from hard_numbers import LARGE, STEPS, TINY, after
from hard_optics import (
    blur,
    depth_of_field,
    distortion,
    projection,
    stops,
    thin_lens,
    vignetting,
    weak_perspective,
)


def gaussian():
    for k in (1, 2, 3, 5, 8, 8.3, 10, 20, 30, 36.7, 37.5, 38, 38.4, 1e-9, 0.3, 0.69, 0.71, 1.19):
        yield "upper_tail", (k,), "tail"
        yield "upper_tail", (-k,), "complement"
        yield "two_sided_tail", (k,), "tail"
        yield "log_tail", (k,), "tail"
        yield "log_tail", (-k,), "ln(1 - Q)"
        yield "expected_beyond", (1e6, k), "mock question C13"
    for k in (100, 1e8, 1e150, 1.8e154, TINY):
        yield "log_tail", (k,), "beyond the range of Q"
    for k in (39, 41, 50):
        yield "expected_beyond", (1e300, k), "subnormal exponential"
    for p in (0.5, 0.25, 0.1, 0.02275, 1e-5, 1e-15, 1e-100, 1e-300, TINY, 1e-310, 0.5 - 2**-54):
        yield "inverse_tail", (p,), "tail"
    for p in (0.5 + 2**-53, 0.75, 0.975, 1 - 2**-53, 1 - 1e-12):
        yield "inverse_tail", (p,), "complement"
    for a, b in (
        (10, 10.0001),
        (20, 20 + 1e-12),
        (5, 6),
        (2, 2.9),
        (0, 1e-300),
        (37, 39),
        (38, 40),
    ):
        yield "interval", (a, b), "far or narrow"
        yield "interval", (-b, -a), "far or narrow, left"
    for a, b in ((-1, 1), (-40, 1e-9), (-1e-12, 1e-12), (-3, 8), (0.5, 0.5)):
        yield "interval", (a, b), "across the mean"
    for z, sigma in product((0, 0.1, 5, 20, 37, 38.3), (1e-170, 1e-3, 0.1, 1, 1e160)):
        yield "pdf", (z * sigma, 0.0, sigma), "sigma squared leaves the range"
    for args in (
        (1e308, -1e308, 1e308),
        (50.1, 49.9, 0.03),
        (TINY, 0.0, TINY),
        (52e-308, 0, 1e-308),
    ):
        yield "pdf", args, "overflow, subnormal"
    for step in (*STEPS, 0.5, 1.0):
        yield "determinant", (3.0, 0.7, 1 - step), "correlation near 1"
        yield "determinant", (3.0, 0.7, step - 1), "correlation near -1"
        yield "peak_2d", (3.0, 0.7, 1 - step), "correlation near 1"
    yield "determinant", (1e158, 1e158, 1 - 2**-53), "product overflows, result does not"
    yield "peak_2d", (1e-200, 1e-150, 0.3), "overflow"


def hsv():
    colours = [
        (0.2, 0.8, 0.4),
        (1.0, 0.0, 1e-20),
        (1.0, 1e-20, 0.0),
        (0.5, 0.5, after(0.5)),
        (0.5, after(0.5), 0.5),
    ]
    colours += [
        (1e-320, 2e-320, 3e-320),
        (1e308, -1e308, 0.0),
        (LARGE, 1e308, -LARGE),
        (0.0, 0.0, -1e-5 + 1),
    ]
    colours += [
        (-0.2, 0.5, 1.3),
        (-1.0, -0.5, -0.25),
        (0.1, 0.3, 0.2),
        (255.0, 254.0, 253.0),
        (0.7, 0.2, after(0.7)),
    ]
    for rgb in colours:
        yield "hue", rgb, "near gray, near 360, subnormal, out of gamut"
        yield "saturation", rgb, "near gray, subnormal, out of gamut"
    turns = [
        (-30.0, 0.8, 1.0),
        (720.0, 0.75, 0.8),
        (1e16, 0.75, 0.8),
        (-1e-300, 0.5, 0.5),
        (60.0, 1.0, 1.0),
    ]
    turns += [
        (120 - 2**-46, 1.0, 0.7),
        (59.99999999999999, 1 - 2**-53, 0.3),
        (359.99999999999994, 0.5, 1.0),
    ]
    turns += [
        (17.0, 1.5, 0.4),
        (200.0, -0.3, 0.4),
        (40.0, 1.5, 0.7),
        (10.0, 3.0, 1e308),
        (300.0, 0.5, 1e-310),
    ]
    for args in turns:
        for name in ("red", "green", "blue"):
            yield name, args, "many turns, sector edges, out of gamut"


def normalise():
    cases = [
        (128.0, 0.0, 255.0, 0.0, 1.0),
        (64.0, 0.0, 255.0, -1.0, 1.0),
        (300.0, 0.0, 255.0, 0.0, 1.0),
    ]
    cases += [(127.5 + s, 0.0, 255.0, -1.0, 1.0) for s in (2**-46, 1e-9, 1e-3)]
    cases += [
        (0.7, 0.1, 0.7, 0.0, 0.9),
        (0.3, 0.1, 0.7, -0.3, 0.3),
        (1e308, -1e308, 1e308, 0.0, 1.0),
    ]
    cases += [
        (2e-320, 1e-320, 3e-320, 0.0, 1.0),
        (50.0, 50.0, after(50.0), 0.0, 255.0),
        (1e-300, 0.0, 1.0, 5.0, 5.0),
    ]
    cases += [
        (0.1 + 0.2, 0.1, 0.3, -1e-3, 1e-3),
        (LARGE, -LARGE, LARGE, -LARGE, LARGE),
        (1.0, 0.0, 3.0, 1.0, -2.0),
    ]
    for args in cases:
        yield "normalise", args, "cancellation, overflow, subnormal range"


def snr():
    for N, sigma in (
        (1e4, 0.0),
        (1e12, 2.0),
        (1e18, 1e-3),
        (1e-3, 10.0),
        (100.0, 5.0),
        (1e308, 1e160),
        (TINY, 1e-170),
        (1e-300, 1e-170),
        (1.0, LARGE),
    ):
        for name in ("snr", "snr_loss", "photons_for"):
            yield name, (N, sigma), "loss near 0, extreme"


def poisson():
    for k, lam in (
        (0, 1e-10),
        (0, 700.0),
        (1, 1e-300),
        (3, 2.5),
        (100, 100.0),
        (80, 100.0),
        (200, 100.0),
        (1e6, 1e6),
        (1e9, 1e9),
        (1e12, 1e12),
        (1e15, 1e15 + 3e7),
        (718, 1464.9643890384557),
        (1000, 3.0),
    ):
        yield "pmf", (k, lam), "mode, far tail, large mean"
    for k, lam in (
        (80, 100.0),
        (120, 100.0),
        (1, 1e-12),
        (5, 30.0),
        (30, 5.0),
        (9600, 1e4),
        (10500, 1e4),
        (59, 60.0),
        (62, 60.0),
        (300, 64.8),
        (90, 180.5),
        (0, 2.0),
    ):
        yield "upper", (k, lam), "either side, seams of the methods"
        yield "lower", (k, lam), "either side, seams of the methods"


def gamma():
    for x in (
        0.0,
        TINY,
        1e-310,
        1e-5,
        0.001,
        0.0031308,
        after(0.0031308),
        0.04045,
        after(0.04045),
        0.18,
        0.5,
        1.0,
        1e100,
        1e300,
    ):
        for name in ("encode", "decode", "srgb_encode", "srgb_decode"):
            yield name, (x,), "knee, subnormal, rounded exponent"
    pairs = [
        (0.2, 0.8),
        (0.25, 0.25 + 1e-8),
        (0.0, 1.0),
        (0.0, TINY),
        (1e308, 1.7e308),
        (0.3, after(0.3)),
        (1.0, 3.0),
    ]
    pairs += [(0.5, 0.5 * (1 + s)) for s in STEPS] + [
        (1.0, 7.0),
        (1.0, 7.000001),
        (1.0, 15.0),
        (1e-300, 1.0),
        (TINY, 1e-320),
    ]
    for a, b in pairs:
        yield "gap", (a, b), "near-equal, seams of the series"


def luminosity():
    for at in (
        0.0,
        359.9,
        360.0,
        after(360.0),
        689.86089,
        555.0,
        557.3,
        829.999,
        830.0,
        830.1,
        LARGE,
    ):
        yield "photopic", (at,), "seams and ends of the table"
    for low, high in (
        (555.0, 555.0), (555.0, after(555.0)), (689.8608941060015, 689.86089412064),
        (359.0, 360.0), (345.8634125509302, 373.14133280118375), (0.0, 1000.0), (400.0, 700.0),
        (829.9999999, 900.0), (540.0, 545.0), (1e-300, LARGE),
    ):  # fmt: skip
        yield "band_flux", (0.005, low, high), "seams, narrow bands, bands beyond the table"
    for centre, fwhm in (
        (532.0, 0.0), (532.0, 1e-300), (532.0, 1e-9), (555.0, 0.1), (557.5, 1.0), (650.0, 20.0),
        (308.0805239558281, 3.368600580051465), (881.8036875491763, 25.02325813593652),
        (300.0, 9.0), (360.0, 1e-3), (830.0, 2.0), (700.0, 300.0), (555.0, 1e6), (890.0, 3.9),
    ):  # fmt: skip
        yield "line_flux", (0.005, centre, fwhm), "narrow, wide, and lines outside the table"
    for wavelength in (555.0, 1e-9, 380.0, LARGE, 1e-320):
        yield "photon_energy_ev", (wavelength,), "range"
        yield "photon_energy", (wavelength * 1e-9 if wavelength > 1e-9 else wavelength,), "range"
    for wavelength, temperature in (
        (555.0, 5778.0), (10000.0, 300.0), (500.0, 40.0), (1e9, 2.7), (1e12, 1e6), (550.0, 35.2),
        (1e150, 2.0833333333333332e-146), (1e-200, 1e-200), (1e200, 1e200), (1e154, 1e-3), (300.0, 64.0),
    ):  # fmt: skip
        yield "planck_factor", (wavelength, temperature), "long waves, cold bodies, range"


FAMILIES = (
    gaussian, thin_lens, blur, depth_of_field, stops, distortion, hsv, normalise, projection,
    weak_perspective, snr, poisson, gamma, vignetting, luminosity,
)  # fmt: skip


def hard_rows():
    """Every ``(family.function, args, origin)``."""
    for family in FAMILIES:
        for name, args, origin in family():
            yield f"{family.__name__}.{name}", tuple(float(arg) for arg in args), origin
