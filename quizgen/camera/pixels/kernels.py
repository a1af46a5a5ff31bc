"""Blur kernels on the pixel grid, and how much of the light they move.

Pixels are area averages, so a point spread function is splatted bilinearly (pixel box * pixel box
* function): the response to an ideal edge between two pixels is then exact at any blur size.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.setup.scene import SceneError

BlurKernel = NDArray[np.float64]

_UNMOVED: BlurKernel = np.ones((1, 1))

SAMPLES = 64
_ROWS = 64
"""Rows worked on at once, so that what lies in between stays small."""
LARGEST_BLUR = 800.0
"""Pixels of the widest blur: a kernel needs memory by its square."""


def check_kernel_size(size: float) -> None:
    """Raise an error if a blur is too wide to be computed.

    Raises
    ------
    SceneError
        If it is wider than `LARGEST_BLUR`, px.
    """
    if not abs(size) <= LARGEST_BLUR:
        raise SceneError(f"a blur of {size:.3g} px is more than {LARGEST_BLUR:g} px")


def _half_chord_integral(x: BlurKernel) -> BlurKernel:
    """Return the integral of sqrt(1 - x^2) from 0 to x."""
    return (x * np.sqrt(np.maximum(0.0, 1.0 - x * x)) + np.arcsin(np.clip(x, -1.0, 1.0))) / 2.0


def disc_area_below(x: BlurKernel, y: BlurKernel) -> BlurKernel:
    """Return the area of the unit disc left of x and below y, both in [-1, 1] (closed form)."""
    corner = np.sqrt(np.maximum(0.0, 1.0 - y * y))
    chord = _half_chord_integral
    caps = np.where(y >= 0.0, 2.0, 0.0)
    left, middle = np.minimum(x, -corner), np.clip(x, -corner, corner)
    right = np.maximum(x, corner)
    return (
        caps * (chord(left) - chord(np.full_like(x, -1.0)))
        + y * (middle + corner)
        + chord(middle)
        - chord(-corner)
        + caps * (chord(right) - chord(corner))
    )


def _bilinear_weights(positions: BlurKernel) -> BlurKernel:
    """Return the weight of every position (px) on every pixel, shape (pixels, positions)."""
    reach = int(np.ceil(np.abs(positions).max()))
    pixels = np.arange(-reach, reach + 1)[:, None]
    return np.asarray(np.maximum(0.0, 1.0 - np.abs(positions[None, :] - pixels)))


def _build_row_splitter(positions: BlurKernel) -> Callable[[BlurKernel], BlurKernel]:
    """Return a function that splits rows at ascending positions (px, > 0) between two pixels each.

    Every pixel up to the last has some. It sums in one thread and one order: a matrix product would
    take all cores for a moment.
    """
    reach = math.floor(positions[-1]) + 1
    starts = np.searchsorted(positions, np.arange(reach))
    share = (positions - np.floor(positions))[:, None]
    rest = 1.0 - share

    def share_rows(rows: BlurKernel) -> BlurKernel:
        """Return the sums of rows, weighted, for every pixel."""
        found = np.zeros((reach + 1, rows.shape[1]))
        found[:-1] = np.add.reduceat(rows * rest, starts)
        found[1:] += np.add.reduceat(rows * share, starts)
        return found

    return share_rows


@lru_cache(maxsize=64)
def disc_kernel(diameter: float) -> BlurKernel:
    """Return the blur kernel of a circular aperture.

    Parameters
    ----------
    diameter : float
        Of the circle of confusion, px, at most `LARGEST_BLUR`; its sign says on which side of the
        plane of focus, and is ignored.

    Returns
    -------
    numpy.ndarray
        Odd-sized square kernel, sums to 1, symmetric in both axes.
    """
    check_kernel_size(diameter)
    radius = abs(diameter) / 2.0
    if radius == 0.0:
        return np.ones((1, 1))
    count = max(SAMPLES, min(32 * math.ceil(radius), 1024), 2 * math.ceil(2.0 * radius))
    return _splat_cells(_disc_cell_areas(count), radius * _cell_centres(count))


@lru_cache(maxsize=16)
def _cell_centres(count: int) -> BlurKernel:
    """Return the middles of the upper half of ``count`` cells on [-1, 1]."""
    return np.asarray((np.arange(count // 2, count) + 0.5) * (2.0 / count) - 1.0)


@lru_cache(maxsize=8)
def _disc_cell_areas(count: int) -> BlurKernel:
    """Return the exact area of a unit disc inside each cell of a count x count grid on [-1, 1]^2.

    One quarter: the cells of [0, 1]^2, shape (count / 2, count / 2), not normalised; ``count`` is
    even.
    """
    half = count // 2
    edges = np.linspace(-1.0, 1.0, count + 1)[half:]
    cells = np.empty((half, half))
    for start in range(0, half, _ROWS):
        rows = edges[start : start + _ROWS + 1]
        below = disc_area_below(*np.meshgrid(edges, rows))
        area = np.diff(np.diff(below, axis=0), axis=1)
        np.maximum(area, 0.0, out=cells[start : start + _ROWS])
    return cells


def _splat_cells(cells: BlurKernel, centres: BlurKernel) -> BlurKernel:
    """Return a symmetric kernel, sum 1, of light at a grid of positions (px along both axes, > 0).

    One quarter stands for all: the light in the middle row and column comes from both sides.
    """
    shared = _build_row_splitter(centres)
    quarter = shared(shared(cells).T).T
    quarter[0] *= 2.0
    quarter[:, 0] *= 2.0
    reach = len(quarter) - 1
    kernel = np.empty((2 * reach + 1, 2 * reach + 1))
    kernel[reach:, reach:], kernel[reach:, :reach] = quarter, quarter[:, :0:-1]
    kernel[:reach] = kernel[:reach:-1]
    return np.asarray(kernel / kernel.sum())


DARK_RINGS = (3.8317059702075125, 16.470630050877634)
"""First and fifth zero of the Bessel function J1."""


def _bessel_j1(x: BlurKernel) -> BlurKernel:
    """Return the Bessel function J1(x) for |x| < 60, the mean of cos(t - x sin t).

    Over whole turns the midpoint rule is exact.
    """
    angles = (np.arange(96) + 0.5) * (math.pi / 96)
    return np.asarray(sum(np.cos(angle - x * math.sin(angle)) for angle in angles) / 96)


def airy_radius(scale: float) -> float:
    """Return the radius of the fifth dark ring, px; ``scale`` is that of `airy_kernel`."""
    return DARK_RINGS[1] * scale / math.pi


@lru_cache(maxsize=64)
def airy_kernel(scale: float) -> BlurKernel:
    """Return the blur kernel of diffraction at a round aperture: (2 J1(x)/x)^2, x = pi r/scale.

    It is cut at the fifth dark ring, within which 96 % of the light lie, and shares out the rest.

    Parameters
    ----------
    scale : float
        Wavelength times f-number in px; the first dark ring has the radius 1.22 of it.

    Returns
    -------
    numpy.ndarray
        Odd-sized square kernel, sums to 1, symmetric in both axes.
    """
    radius = airy_radius(scale)
    check_kernel_size(2.0 * radius)
    if radius < 1e-6:
        return np.ones((1, 1))
    count = max(2 * SAMPLES, min(16 * math.ceil(radius), 1024), 2 * math.ceil(2.0 * radius))
    centres = radius * _cell_centres(count)
    far = np.hypot(centres[:, None], centres[None, :]) * (math.pi / scale)
    light = np.where(far < DARK_RINGS[1], (2.0 * _bessel_j1(far) / far) ** 2, 0.0)
    return _splat_cells(light, centres)


@lru_cache(maxsize=64)
def motion_kernel(across: float, down: float) -> BlurKernel:
    """Return the blur kernel of a straight, uniform motion.

    Parameters
    ----------
    across, down : float
        Path during the exposure in px (x to the right, y down).

    Returns
    -------
    numpy.ndarray
        Odd-sized kernel (height, width), sums to 1, symmetric about its centre. The variance along
        the path is L^2/12 plus that of the pixel grid (errata E40: a box, not a Gaussian).
    """
    check_kernel_size(max(abs(across), abs(down)))
    count = max(SAMPLES, 16 * math.ceil(max(abs(across), abs(down))))
    times = (np.arange(count) + 0.5) / count - 0.5
    kernel = _bilinear_weights(down * times) @ _bilinear_weights(across * times).T / count
    kernel = (kernel + kernel[::-1, ::-1]) / 2.0
    return np.asarray(kernel / kernel.sum())


def moved_share(one: BlurKernel, other: BlurKernel = _UNMOVED) -> float:
    """Return the share of light that two kernels bring to different places, at most 1.

    No value changes by more than this share of the range if one kernel replaces the other.

    Parameters
    ----------
    one, other : numpy.ndarray
        Square or not, odd-sized, each with sum 1; by default the light that stays where it is.
    """
    sides = [max(pair) for pair in zip(one.shape, other.shape, strict=True)]
    return float(np.abs(_widen_kernel(one, sides) - _widen_kernel(other, sides)).sum() / 2.0)


def _widen_kernel(kernel: BlurKernel, sides: list[int]) -> BlurKernel:
    """Return a kernel with zeros around it, up to the given sides."""
    margins = [((side - had) // 2,) * 2 for side, had in zip(sides, kernel.shape, strict=True)]
    return np.pad(kernel, margins)
