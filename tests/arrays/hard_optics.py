"""Inputs of lenses, cameras and projections aimed at poles, folds, ties and overflow.

Each generator yields ``(function, args, origin)``. No value here depends on the code under test.
"""

# ruff: noqa: N806 - mathematics and tables of inputs

from __future__ import annotations

from hard_numbers import LARGE, SMALL, STEPS, TINY, after


def thin_lens():
    pairs = [(50.0, after(50.0, n)) for n in (1, 2, 3)] + [
        (50.0, 50 - 2**-47),
        (0.05, 0.05 * (1 + 1e-12)),
    ]
    pairs += [(f, f * (1 + s)) for f in (3.0, 0.05) for s in STEPS]
    pairs += [(50.0, 1e308), (1e-320, 1e-300), (1e308, 1.5e308), (1e300, 1e-10), (LARGE, TINY)]
    pairs += [(50.0, 200.0), (0.035, 7.3), (50.0, 20.0), (SMALL, after(SMALL)), (3.0, 1.7e308)]
    for f, z in pairs:
        for name in ("image_distance", "focus_shift", "magnification"):
            yield name, (f, z), "pole z = f, overflow"


def blur():
    cases = [(50.0, 2.8, 3000.0, after(3000.0, n)) for n in (1, 2)]
    cases += [(0.05, 1.8, 3.0, 3.0 * (1 + s)) for s in STEPS]
    cases += [(50.0, 2.8, 50 * (1 + s), 100.0) for s in STEPS]
    cases += [(50.0, 2.0, 3000.0, 50.0), (50.0, 2.0, 3000.0, 20.0), (50.0, 2.0, 3000.0, 1e300)]
    cases += [(1e-300, 1e-5, 1e-299, 3.0), (1e200, 1e150, 1e201, 1e202), (TINY, 1.0, 1.0, 1.0)]
    for args in cases:
        yield "blur_disc", args, "z near s, s near f, overflow"


def depth_of_field():
    for s in (10466.666666666564, 10466.0, 10000.0, 3000.0, 500.0, 51.0, 50.000001, 20000.0):
        for name in ("near_limit", "far_limit", "total_depth"):
            yield name, (50.0, 8.0, 0.03, s), "s near the hyperfocal distance, macro"
    H = 50 + 2500 / (2 * 0.025)
    for s in (H - 1e-10, H - 1e-6, H + 1e-10):
        yield "far_limit", (50.0, 2.0, 0.025, s), "hyperfocal distance"
        yield "total_depth", (50.0, 2.0, 0.025, s), "hyperfocal distance"
    yield "far_limit", (50.0, 2.0, 0.03125, 40050.0), "tie with the hyperfocal distance"
    for args in (
        (1e-170, 1e3, 1e-5),
        (50.0, 8.0, 0.03),
        (1e200, 1e-150, 1e-100),
        (1e155, 1e3, 1e8),
    ):
        yield "hyperfocal", args, "overflow"
    for s in (60.0, 1000.0):
        yield "total_depth", (50.0, 1e-12, 0.03, s), "tiny depth"


def stops():
    pairs = [(2.0, 5.6), (4.0, 4 * (1 + 1e-10)), (2.0, 8.0), (2.8, after(2.8)), (1.0, 1 - 2**-53)]
    pairs += [(11.0, 11 * (1 + s)) for s in STEPS] + [(1.0, 2 - 2**-52), (1.0, 0.5 + 2**-53)]
    pairs += [(TINY, LARGE), (LARGE, TINY), (1e-310, 1e-320), (1.8, 16.0), (5.0, 10.0 + 1e-14)]
    for a, b in pairs:
        yield "stops", (a, b), "near-equal, extreme"
        yield "light_ratio", (a, b), "near-equal, extreme"


def distortion():
    for r in (0.6928203230275509, 0.7698003589187312, 0.76980035, 0.1, 1e-9, 1e-300, 0.5):
        yield "inverse_radius", (r, -0.25, 0.0), "up to the fold"
        yield "correction", (r, -0.25, 0.0), "up to the fold"
    for r, k in (
        (1.0, 5.0),
        (1e3, 5.0),
        (1.0, 1e-14),
        (1.0, -1e-14),
        (1e150, 1e-300),
        (1e100, 1e300),
    ):
        yield "inverse_radius", (r, k, 0.0), "pincushion, tiny and huge coefficient"
        yield "correction", (r, k, 0.0), "pincushion, tiny and huge coefficient"
        yield "displacement", (r, k, 0.0), "tiny coefficient"
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
            yield "displacement", (r, k1, k2), "two coefficients"
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
    yield "displacement", (1.0, -0.3, after(0.3, 2)), "terms cancel"
    for k in (3.0, 1e6, 1e12):
        yield "distort_x", (0.6, 0.8, k, -after(k, 5)), "two large terms cancel"


def projection():
    for args in (
        (2.0, 10.0, 3.0),
        (1e200, 1e200, 1e150),
        (1e-200, 1e-200, 1e-300),
        (50.0, 1.0, TINY),
        (2.0, -1.0, -3.0),
        (3.0, TINY, 7.0),
    ):
        yield "project_x", args, "overflow, subnormal, behind"
    for args in (
        (0.002, 5e-6, -1.0, 2.0, 320.0), (0.005, 5e-6, 0.2, 2.0, 320.0), (0.0035, 2.5e-6, 0.3, 0.7, 319.5),
        (0.05, 5e-6, 0.1 + 0.2, 3.0, 0.1), (0.002, 5e-6, -1.6, 2.0, 320.0), (0.05, 5e-6, 1 / 3, 0.1, -0.25),
    ):  # fmt: skip
        yield "pixel", args, "integer answers, cancellation with the principal point"


def weak_perspective():
    for z, zbar in (
        (99.0, 100.0),
        (after(100.0), 100.0),
        (100 * (1 + 1e-10), 100.0),
        (TINY, 1.0),
        (1e308, 1e-5),
        (1e-310, 2e-310),
        (0.1, 0.3),
    ):
        yield "scale_error", (z, zbar), "z near zbar, extreme"
        yield "scale_error_of_weak", (z, zbar), "z near zbar, extreme"


def vignetting():
    for r, f in (
        (0.0, 50.0),
        (1e-8, 1.0),
        (21.6, 50.0),
        (1e-200, 1.0),
        (1e80, 1.0),
        (1e200, 1e-3),
        (TINY, LARGE),
        (50.0, 50.0),
        (3.0, 1e-310),
        (1e-4, 0.35),
    ):
        yield "cos4", (r, f), "small angle, overflow"
        yield "falloff", (r, f), "small angle, overflow"
