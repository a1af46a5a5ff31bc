"""Inputs of lenses, cameras and projections aimed at poles, folds, ties and overflow.

Each generator yields ``(function, args, origin)``. No value here depends on the code under test.
"""

# ruff: noqa: N806 - mathematics and tables of inputs

from __future__ import annotations

from hard_numbers import TINY, after


def depth_of_field():
    for s in (10466.666666666564, 10466.0, 10000.0, 3000.0, 500.0, 51.0, 50.000001, 20000.0):
        yield "far_limit", (50.0, 8.0, 0.03, s), "s near the hyperfocal distance, macro"
    H = 50 + 2500 / (2 * 0.025)
    for s in (H - 1e-10, H - 1e-6, H + 1e-10):
        yield "far_limit", (50.0, 2.0, 0.025, s), "hyperfocal distance"
    yield "far_limit", (50.0, 2.0, 0.03125, 40050.0), "tie with the hyperfocal distance"


def distortion():
    for r in (0.6928203230275509, 0.7698003589187312, 0.76980035, 0.1, 1e-9, 1e-300, 0.5):
        yield "inverse_radius", (r, -0.25, 0.0), "up to the fold"
    for r, k in (
        (1.0, 5.0),
        (1e3, 5.0),
        (1.0, 1e-14),
        (1.0, -1e-14),
        (1e150, 1e-300),
        (1e100, 1e300),
    ):
        yield "inverse_radius", (r, k, 0.0), "pincushion, tiny and huge coefficient"
    for k1, k2 in (
        (-0.3, 0.1),
        (-0.3, 0.0202),
        (-0.3, 0.041),
        (0.2, -0.1),
        (-0.2, -0.05),
        (0.1, 0.1),
        (0.0, -0.2),
    ):
        yield "fold_radius", (k1, k2), "tie of two folds"
        for r in (0.2, 0.5, 0.6):
            yield "inverse_radius", (r, k1, k2), "two coefficients"
    for k1, k2 in (
        (-0.3, 0.0405),
        (-0.3, after(0.0405, 3)),
        (1e-9, -1e-20),
        (-1e200, 1e300),
        (1e-300, -TINY),
    ):
        yield "fold_radius", (k1, k2), "discriminant near 0, extreme"
    for x, y, k1, k2 in (
        (1.0, 0.0, -1 + 1e-12, 0.0), (0.5, 0.5, -2.0 + 1e-9, 0.0), (0.3, 0.4, -4.000000001, 0.0),
        (1e-200, 0.0, -0.2, 0.0), (1e120, 1e100, -1e-250, 0.0), (0.5, 0.5, 0.2, -0.4), (1.0, 1.0, -0.2, 0.05),
    ):  # fmt: skip
        yield "distort_x", (x, y, k1, k2), "factor near 0, extreme"
    for k in (3.0, 1e6, 1e12):
        yield "distort_x", (0.6, 0.8, k, -after(k, 5)), "two large terms cancel"


def projection():
    for args in (
        (0.002, 5e-6, -1.0, 2.0, 320.0), (0.005, 5e-6, 0.2, 2.0, 320.0), (0.0035, 2.5e-6, 0.3, 0.7, 319.5),
        (0.05, 5e-6, 0.1 + 0.2, 3.0, 0.1), (0.002, 5e-6, -1.6, 2.0, 320.0), (0.05, 5e-6, 1 / 3, 0.1, -0.25),
    ):  # fmt: skip
        yield "pixel_coordinate", args, "integer answers, cancellation with the principal point"
