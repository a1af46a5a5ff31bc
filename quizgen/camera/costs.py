"""What every effect costs, ms: measured at two sizes, with and without OpenCV.

``benchmarks/camera.py --calibrate`` prints the table anew. Plans are chosen with the NumPy column
only, so that installing OpenCV never changes a picture; predicted times use what is installed.
"""

# ruff: noqa: ARG001 - every cost takes the same arguments

from __future__ import annotations

import math

from quizgen.camera.draw import sheets
from quizgen.camera.effects.optics import slices, turns
from quizgen.camera.effects.optics_bounds import blur_of, map_range
from quizgen.camera.filters import goes_by_slabs, opencv
from quizgen.camera.kernels import Kernel, disc, line
from quizgen.camera.scene import View

SIZES = (0.3072, 12.0)
"""Megapixels of the two columns: 640 x 480 and 4000 x 3000."""

Pair = tuple[float, float]

POINTWISE: dict[str, Pair] = {
    "vignetting": (1.55, 115),
    "exposure": (0.0786, 18),
    "shot noise": (15.5, 690),
    "shot noise/gaussian": (8.2, 330),
    "dark current": (22, 1050),
    "blooming": (9.37, 215),
    "streak": (0.483, 40.2),
    "full well": (0.338, 25.9),
    "read noise": (7.16, 292),
    "mosaic": (0.134, 18.6),
    "quantisation": (0.39, 38.4),
    "demosaicing": (1.64, 173),
    "flat field": (1.34, 88.2),
    "white balance": (1.55, 76.5),
    "gamma": (1.9, 92),
    "gamma/table": (1.5, 76),
    "hsv edit": (38.4, 1490),
    "gaussian noise": (7.18, 302),
    "impulse noise": (4.13, 200),
    "normalisation": (0.313, 36.7),
    "projection": (0.05, 0.05),
}

POINTWISE_OPENCV: dict[str, Pair] = {"hsv edit": (1.5, 75)}

SAMPLE: Pair = (41.7, 916)
SAMPLE_OPENCV: Pair = (1.37, 68.2)
NEAREST: Pair = (4.15, 238)
MAP: Pair = (1.25, 234)
LATERAL: Pair = (2.46, 306)
TAP: Pair = (0.49, 30.1)
FOURIER: Pair = (26.1, 2861)
TAP_OPENCV: Pair = (0.017, 1.74)
SLAB_TAP_OPENCV: Pair = (0.045, 1.4)
FOURIER_OPENCV: Pair = (9.5, 390)
_CALL = 0.01
FACTS_PER_MEGAPIXEL = 35.0
"""Measuring a picture's steps, ms."""


def at_size(pair: Pair, megapixels: float) -> float:
    """Cost between and beyond the two measured sizes: a power law."""
    power = math.log(pair[1] / pair[0]) / math.log(SIZES[1] / SIZES[0])
    return float(pair[0] * (megapixels / SIZES[0]) ** power)


def _convolution(kernel: Kernel, view: View, *, opencv_used: bool) -> float:
    height, width, taps = *kernel.shape, int((kernel > 0).sum())
    if taps == 1:
        return 0.0
    if opencv_used:
        if height * width <= 11 * 11:
            return 0.1 + at_size(TAP_OPENCV, view.megapixels) * float(20 + height * width)
        if goes_by_slabs(kernel):
            return at_size(SLAB_TAP_OPENCV, view.megapixels) * taps
        return at_size(FOURIER_OPENCV, view.megapixels)
    few = taps <= 49
    return at_size(TAP, view.megapixels) * taps if few else at_size(FOURIER, view.megapixels)


def _blur(diameter: float, view: View, *, opencv_used: bool) -> float:
    return _convolution(disc(diameter), view, opencv_used=opencv_used)


def _defocus(rung: str, view: View, *, opencv_used: bool) -> float:
    total = 0.0
    for sheet in sheets(view):
        if sheet.depth is None and sheet.opaque:
            middles = slices(map_range(view), rung)
            total += sum(_blur(float(c), view, opencv_used=opencv_used) for c in middles) * 1.5
        else:
            share = 1.0 if sheet.opaque else 4.0 / 3.0
            total += share * _blur(blur_of(sheet, view), view, opencv_used=opencv_used)
    return total


def _sample(view: View, *, opencv_used: bool) -> float:
    return at_size(SAMPLE_OPENCV if opencv_used else SAMPLE, view.megapixels)


def _motion(rung: str, view: View, *, opencv_used: bool) -> float:
    total, shutter = 0.0, view.camera.shutter
    for sheet in sheets(view):
        across, down = (
            (own + pan) * shutter
            for own, pan in zip(sheet.motion.velocity, view.camera.velocity, strict=True)
        )
        total += _convolution(line(across, down), view, opencv_used=opencv_used)
        if sheet.motion.spin:
            count = turns(sheet.motion.spin, sheet.motion.reach, shutter)
            positions = max(1, count // 2) if rung == "half" else count
            total += positions * 1.8 * _sample(view, opencv_used=opencv_used)
    return total


def _rolling(rung: str, view: View, *, opencv_used: bool) -> float:
    layers = sum(1 for sheet in sheets(view) if not sheet.motion.still or any(view.camera.velocity))
    return layers * 1.8 * _sample(view, opencv_used=opencv_used)


def _distortion(rung: str, view: View, *, opencv_used: bool) -> float:
    one = (
        at_size(NEAREST, view.megapixels)
        if rung == "nearest"
        else _sample(view, opencv_used=opencv_used)
    )
    layers = sheets(view)
    return at_size(MAP, view.megapixels) + one * (1.0 + 1.3 * (len(layers) - 1))


def _lateral(rung: str, view: View, *, opencv_used: bool) -> float:
    layers = 2 * len(sheets(view)) - 1
    return at_size(LATERAL, view.megapixels) * layers


SPATIAL = {
    "defocus": _defocus,
    "motion blur": _motion,
    "rolling shutter": _rolling,
    "distortion": _distortion,
    "lateral colour": _lateral,
}


def cost(effect: str, rung: str, view: View, *, opencv_used: bool | None = None) -> float:
    """Predicted time of one effect, ms.

    Parameters
    ----------
    effect, rung : str
    view : View
        Projected to px.
    opencv_used : bool, optional
        By default whether OpenCV is installed.
    """
    used = opencv() is not None if opencv_used is None else opencv_used
    if effect in SPATIAL:
        return max(_CALL, SPATIAL[effect](rung, view, opencv_used=used))
    name = f"{effect}/{rung}" if rung else effect
    table = POINTWISE_OPENCV if used and name in POINTWISE_OPENCV else POINTWISE
    return at_size(table[name], view.megapixels)
