"""What every effect costs, ms: measured at two sizes, with and without OpenCV.

``benchmarks/camera.py --calibrate`` prints the table anew. Plans are chosen with the NumPy column
only, so that installing OpenCV never changes a picture; predicted times use what is installed.
"""

from __future__ import annotations

import math

from quizgen.camera.draw import sheets
from quizgen.camera.effects.optics import slice_edges, turns
from quizgen.camera.effects.optics_bounds import blur_of, map_range
from quizgen.camera.filters import opencv
from quizgen.camera.kernels import disc, line
from quizgen.camera.scene import View

SIZES = (0.3072, 12.0)
"""Megapixels of the two columns: 640 x 480 and 4000 x 3000."""

Pair = tuple[float, float]

POINTWISE: dict[str, Pair] = {
    "vignetting": (0.35, 28.0),
    "exposure": (0.2, 20.0),
    "shot noise": (26.0, 1100.0),
    "shot noise/gaussian": (8.0, 350.0),
    "dark current": (20.0, 900.0),
    "blooming": (6.0, 200.0),
    "streak": (1.0, 60.0),
    "full well": (0.2, 20.0),
    "read noise": (7.0, 300.0),
    "mosaic": (0.5, 40.0),
    "quantisation": (0.8, 60.0),
    "demosaicing": (3.0, 200.0),
    "flat field": (0.6, 60.0),
    "white balance": (1.0, 60.0),
    "gamma": (3.5, 190.0),
    "hsv edit": (40.0, 1700.0),
    "gaussian noise": (7.0, 300.0),
    "impulse noise": (3.0, 150.0),
    "normalisation": (0.8, 60.0),
    "projection": (0.05, 0.05),
}

POINTWISE_OPENCV: dict[str, Pair] = {"hsv edit": (1.0, 60.0)}

SAMPLE: Pair = (25.0, 1400.0)
SAMPLE_OPENCV: Pair = (0.8, 60.0)
NEAREST: Pair = (8.0, 500.0)
MAP: Pair = (6.0, 350.0)
LATERAL: Pair = (6.0, 300.0)
TAP: Pair = (0.45, 45.0)
FOURIER: Pair = (60.0, 4000.0)
TAP_OPENCV: Pair = (0.02, 1.2)
FOURIER_OPENCV: Pair = (8.0, 400.0)
FACTS_PER_MEGAPIXEL = 35.0
"""Measuring a picture's steps, ms."""


def at_size(pair: Pair, megapixels: float) -> float:
    """Cost between and beyond the two measured sizes: a power law."""
    power = math.log(pair[1] / pair[0]) / math.log(SIZES[1] / SIZES[0])
    return pair[0] * (megapixels / SIZES[0]) ** power


def _convolution(height: int, width: int, taps: int, view: View, *, opencv_used: bool) -> float:
    if taps == 1:
        return 0.0
    if opencv_used:
        if height * width <= 11 * 11:  # noqa: PLR2004 - OpenCV's own limit
            return 0.1 + at_size(TAP_OPENCV, view.megapixels) * (20 + height * width)
        return at_size(FOURIER_OPENCV, view.megapixels)
    few = taps <= 49  # noqa: PLR2004 - see filters
    return at_size(TAP, view.megapixels) * taps if few else at_size(FOURIER, view.megapixels)


def _blur(diameter: float, view: View, *, opencv_used: bool) -> float:
    kernel = disc(diameter)
    taps = int((kernel > 0).sum())
    return _convolution(*kernel.shape, taps, view, opencv_used=opencv_used)


def _defocus(rung: str, view: View, *, opencv_used: bool) -> float:
    total = 0.0
    for sheet in sheets(view):
        if sheet.depth is None and sheet.opaque:
            edges = slice_edges(map_range(view), rung)
            middles = (edges[1:] + edges[:-1]) / 2
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
        kernel = line(across, down)
        taps = int((kernel > 0).sum())
        total += _convolution(*kernel.shape, taps, view, opencv_used=opencv_used)
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
        return SPATIAL[effect](rung, view, opencv_used=used)
    name = f"{effect}/{rung}" if rung else effect
    table = POINTWISE_OPENCV if used and name in POINTWISE_OPENCV else POINTWISE
    return at_size(table[name], view.megapixels)
