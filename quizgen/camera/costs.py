"""What the building blocks of effects cost, ms: measured at two sizes, with and without OpenCV.

``benchmarks/camera.py --calibrate`` measures anew. Plans are chosen with the NumPy figures only, so
that installing OpenCV never changes a picture; predicted times use what is installed.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from quizgen.camera.effect import Cost
from quizgen.camera.filters import goes_by_slabs
from quizgen.camera.kernels import Kernel
from quizgen.camera.view import View

SIZES = (0.3072, 12.0)
"""Megapixels of the two columns: 640 x 480 and 4000 x 3000."""

Pair = tuple[float, float]

SAMPLE: Pair = (7.09, 410)
SAMPLE_OPENCV: Pair = (0.364, 19.2)
TAP: Pair = (0.49, 30.1)
FOURIER: Pair = (26.1, 2861)
TAP_OPENCV: Pair = (0.017, 1.74)
SLAB_TAP_OPENCV: Pair = (0.045, 1.4)
FOURIER_OPENCV: Pair = (9.5, 390)
_CALL = 0.01
FACTS_PER_MEGAPIXEL = 35.0
"""Measuring a picture's steps, ms."""


@lru_cache(maxsize=256)
def at_size(pair: Pair, megapixels: float) -> float:
    """Cost between and beyond the two measured sizes: a power law."""
    power = math.log(pair[1] / pair[0]) / math.log(SIZES[1] / SIZES[0])
    return float(pair[0] * (megapixels / SIZES[0]) ** power)


def measured(exact: Pair, *, opencv: Pair | None = None, **rungs: Pair) -> Cost:
    """Cost that depends on the picture's size alone.

    Parameters
    ----------
    exact : (float, float)
        ms at `SIZES`.
    opencv : (float, float), optional
        The same with OpenCV, if that makes a difference.
    **rungs : (float, float)
        The same for the cheaper ways.
    """

    def cost(view: View, rung: str, opencv_used: bool) -> float:
        pair = opencv if opencv_used and opencv and not rung else rungs.get(rung, exact)
        return at_size(pair, view.megapixels)

    return cost


def at_least_a_call(cost: Cost) -> Cost:
    """A cost that may be nothing, such as a blur of no width: calling takes time too.

    What is even all over is not worked on.
    """

    def more(view: View, rung: str, opencv_used: bool) -> float:
        if view.scene.image is None and not view.scene.things:
            return _CALL
        return max(_CALL, cost(view, rung, opencv_used))

    return more


def convolution(kernel: Kernel, view: View, opencv_used: bool) -> float:
    """Cost of `quizgen.camera.filters.convolve`."""
    height, width, taps = *kernel.shape, int(np.count_nonzero(kernel))
    if taps == 1:
        return 0.0
    if opencv_used:
        if height * width <= 11 * 11:
            return 0.1 + at_size(TAP_OPENCV, view.megapixels) * float(20 + height * width)
        if goes_by_slabs(kernel):
            return at_size(SLAB_TAP_OPENCV, view.megapixels) * taps
        return wide_convolution(view, opencv_used)
    few = taps <= 49
    return at_size(TAP, view.megapixels) * taps if few else wide_convolution(view, opencv_used)


def wide_convolution(view: View, opencv_used: bool) -> float:
    """The same of a kernel with so many taps that it goes by transforms: it need not be made."""
    return at_size(FOURIER_OPENCV if opencv_used else FOURIER, view.megapixels)


def sampling(view: View, opencv_used: bool) -> float:
    """Cost of `quizgen.camera.filters.sample`."""
    return at_size(SAMPLE_OPENCV if opencv_used else SAMPLE, view.megapixels)
