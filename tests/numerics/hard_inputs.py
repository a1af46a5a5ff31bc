"""Inputs aimed at poles, folds, ties, cancellation, overflow and subnormals, with their origin.

Each generator yields ``(function, args, origin)``. No value here depends on the code under test.
Those of lenses and cameras stand in ``hard_optics``.
"""

from __future__ import annotations

from hard_numbers import LARGE, STEPS, TINY, after
from hard_optics import depth_of_field, distortion, projection


def gaussian():
    for k in (1, 2, 3, 5, 8, 8.3, 10, 20, 30, 36.7, 37.5, 38, 38.4, 1e-9, 0.3, 0.69, 0.71, 1.19):
        yield "upper_tail", (k,), "tail"
        yield "upper_tail", (-k,), "complement"
        yield "two_sided_tail", (k,), "tail"
    for p in (0.5, 0.25, 0.1, 0.02275, 1e-5, 1e-15, 1e-100, 1e-300, TINY, 1e-310, 0.5 - 2**-54):
        yield "inverse_upper_tail", (p,), "tail"
    for p in (0.5 + 2**-53, 0.75, 0.975, 1 - 2**-53, 1 - 1e-12):
        yield "inverse_upper_tail", (p,), "complement"


def hsv():
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
        yield "srgb_decode", (x,), "knee, subnormal, rounded exponent"
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
        yield "luminous_efficiency", (at,), "seams and ends of the table"


FAMILIES = (gaussian, depth_of_field, distortion, hsv, projection, poisson, gamma, luminosity)


def hard_rows():
    """Every ``(family.function, args, origin)``."""
    for family in FAMILIES:
        for name, args, origin in family():
            yield f"{family.__name__}.{name}", tuple(float(arg) for arg in args), origin
