"""Convolution and resampling: OpenCV when the extra ``image`` is installed, NumPy otherwise.

Both ways compute the same weights in single precision or better and agree within 2e-5 of the
largest value. OpenCV below 5 rounds sampling positions to 1/32 px (up to 4 grey levels on an
edge); it is tried once and not used for resampling when it does.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.pixels.tiles import split_range
from quizgen.camera.setup.scene import Image

_SHIFT_TAPS = 49
_ROWS = 64
_GRID_ROWS = 32
_BAND = 128
_DIRECT_AREA = 129
"""Up to 11 x 11 taps OpenCV sums directly, on all cores; above, it transforms on one."""
_DIRECT_TAPS = 190


_numpy_only: ContextVar[bool] = ContextVar("numpy only", default=False)


def load_opencv() -> ModuleType | None:
    """Return OpenCV if it can be imported and is allowed here, else None."""
    return None if _numpy_only.get() else _import_opencv()


@cache
def _import_opencv() -> ModuleType | None:
    """Return OpenCV, or None if it is not installed."""
    try:
        import cv2
    except ImportError:
        return None
    return cv2


@contextmanager
def numpy_only() -> Iterator[None]:
    """Forbid OpenCV inside the block: a picture is then the same with and without it."""
    before = _numpy_only.set(True)
    try:
        yield
    finally:
        _numpy_only.reset(before)


@cache
def _opencv_remap_is_exact() -> bool:
    """Return whether OpenCV interpolates with full precision; old versions round positions."""
    cv2 = load_opencv()
    if cv2 is None:
        return False
    ramp = np.array([[0.0, 1.0], [0.0, 1.0]], np.float32)
    where = np.full((1, 1), 0.3, np.float32)
    return bool(abs(cv2.remap(ramp, where, where, cv2.INTER_LINEAR)[0, 0] - 0.3) < 1e-6)


def warm_up() -> None:
    """Load OpenCV and try it, so that no effect is timed with its import."""
    if load_opencv() is not None:
        _opencv_remap_is_exact()


def convolve(image: Image, kernel: NDArray[np.float64]) -> Image:
    """Return a picture convolved with a kernel symmetric about its centre; edges repeat outward.

    Parameters
    ----------
    image : numpy.ndarray
        Shape (H, W, C), float32 or float64.
    kernel : numpy.ndarray
        Odd-sized, non-negative.
    """
    cv2 = load_opencv()
    kernel = _fold_kernel(_fold_kernel(kernel, image.shape[0]).T, image.shape[1]).T
    if kernel.size == 1:
        return image
    if cv2 is not None and is_direct_sum_faster(kernel):
        return _convolve_by_slabs(cv2, image, kernel)
    if cv2 is not None:
        return cv2.filter2D(image, -1, kernel, borderType=cv2.BORDER_REPLICATE).reshape(image.shape)
    if np.count_nonzero(kernel) <= _SHIFT_TAPS:
        return _convolve_by_shifts(image, kernel)
    return _convolve_by_fourier(image, kernel)


def _fold_kernel(kernel: NDArray[np.float64], length: int) -> NDArray[np.float64]:
    """Return an equivalent kernel, no higher than a picture of this length can show.

    Its rows beyond the edge all read the edge, and are added up.
    """
    beyond = kernel.shape[0] // 2 - (length - 1)
    if beyond <= 0:
        return kernel
    inner = kernel[beyond:-beyond].copy()
    inner[0] += kernel[:beyond].sum(axis=0)
    inner[-1] += kernel[-beyond:].sum(axis=0)
    return inner


def is_direct_sum_faster(kernel: NDArray[np.float64]) -> bool:
    """Return whether summing few taps directly beats OpenCV's Fourier transform."""
    if kernel.size <= _DIRECT_AREA or kernel.shape[1] > _DIRECT_AREA:
        return False
    return bool(np.count_nonzero(kernel) <= _DIRECT_TAPS)


def _convolve_by_slabs(cv2: ModuleType, image: Image, kernel: NDArray[np.float64]) -> Image:
    """Return the convolution by OpenCV, few kernel rows at a time so that it sums directly."""
    result, reach = np.empty_like(image), kernel.shape[0] // 2
    for start, stop in split_range(len(image), _BAND):
        rows = _pad_rows(image, start - reach, stop + reach)
        result[start:stop] = _convolve_slab(cv2, rows, kernel, stop - start)
    return result


def _pad_rows(image: Image, start: int, stop: int) -> Image:
    """Return rows from start to stop, which may lie outside: the first and last row repeat."""
    if start >= 0 and stop <= len(image):
        return image[start:stop]
    return image[np.clip(np.arange(start, stop), 0, len(image) - 1)]


def _convolve_slab(cv2: ModuleType, rows: Image, kernel: NDArray[np.float64], count: int) -> Image:
    """Return ``count`` rows of the result from ``count + len(kernel) - 1`` rows."""
    total = np.zeros((count, *rows.shape[1:]), rows.dtype)
    high = max(1, _DIRECT_AREA // kernel.shape[1])
    for top in range(0, len(kernel), high):
        slab = kernel[top : top + high]
        taken = rows[top : top + len(slab) - 1 + count]
        found = cv2.filter2D(taken, -1, slab, borderType=cv2.BORDER_REPLICATE)
        total += found.reshape(taken.shape)[len(slab) // 2 :][:count]
    return total


def _pad_edges(image: Image, kernel: NDArray[np.float64]) -> Image:
    """Return a picture with its edges repeated by half the kernel on each side."""
    height, width = image.shape[:2]
    rows, columns = (side // 2 for side in kernel.shape)
    wide = np.empty((height + 2 * rows, width + 2 * columns, image.shape[2]), image.dtype)
    inner = slice(columns, columns + width)
    wide[rows : rows + height, inner] = image
    wide[:rows, inner], wide[rows + height :, inner] = image[0], image[-1]
    wide[:, :columns] = wide[:, columns : columns + 1]
    wide[:, columns + width :] = wide[:, columns + width - 1 : columns + width]
    return wide


def _convolve_by_shifts(image: Image, kernel: NDArray[np.float64]) -> Image:
    """Return the convolution as a sum of shifted pictures, in NumPy.

    A shift is a distance along all values in one row, which is faster than row by row.
    """
    height, width, channels = image.shape
    wide = _pad_edges(image, kernel)
    flat, line = wide.reshape(-1), wide.shape[1] * channels
    result = np.zeros((height, *wide.shape[1:]), image.dtype)
    total = result.reshape(-1)[: height * line - (wide.shape[1] - width) * channels]
    part = np.empty_like(total)
    for row, weights in enumerate(kernel.tolist()):
        for column, weight in enumerate(weights):
            if weight:
                start = row * line + column * channels
                total += np.multiply(flat[start : start + total.size], weight, out=part)
    return np.ascontiguousarray(result[:, :width])


def _convolve_by_fourier(image: Image, kernel: NDArray[np.float64]) -> Image:
    """Return the convolution by Fourier transform in double precision.

    So rounding differs between machines only below one part in 1e12.
    """
    wide, result = _pad_edges(image, kernel), np.empty_like(image)
    shape = tuple(_next_fast_length(side) for side in wide.shape[:2])
    spectrum = np.fft.rfft2(kernel, shape)
    rows, columns = (side - 1 for side in kernel.shape)
    for channel in range(image.shape[2]):
        blurred = np.fft.irfft2(np.fft.rfft2(wide[..., channel], shape) * spectrum, shape)
        result[..., channel] = blurred[
            rows : rows + image.shape[0], columns : columns + image.shape[1]
        ]
    return result


def _next_fast_length(side: int) -> int:
    """Return the next length without large prime factors, where Fourier transforms are fast."""
    while True:
        rest = side
        for prime in (2, 3, 5):
            while rest % prime == 0:
                rest //= prime
        if rest == 1:
            return side
        side += 1


def sample_bilinear(image: Image, x: Image, y: Image) -> Image:
    """Return a picture read at fractional positions, bilinearly; outside, the edge repeats.

    Parameters
    ----------
    image : numpy.ndarray
        Shape (H, W, C), float32 or float64.
    x, y : numpy.ndarray
        Shape (H', W'), positions in px from the centre of the first pixel.
    """
    cv2 = load_opencv()
    single = image.dtype == np.float32 and max(image.shape[:2]) < 2**15
    if cv2 is not None and single and _opencv_remap_is_exact():
        flags = {"borderMode": cv2.BORDER_REPLICATE}
        found = cv2.remap(image, x, y, cv2.INTER_LINEAR, **flags)
        return np.asarray(found.reshape(*x.shape, image.shape[2]))
    result = np.empty((*x.shape, image.shape[2]), image.dtype)
    image = np.ascontiguousarray(image)
    for start, stop in split_range(len(result), _ROWS):
        result[start:stop] = _sample_rows(image, x[start:stop], y[start:stop])
    return result


def _split_position(
    position: Image, length: int
) -> tuple[NDArray[np.intp], NDArray[np.intp], Image]:
    """Return the pixels before and after each position, and the share of the way between them."""
    position = np.clip(position, 0, length - 1)
    first = position.astype(np.intp)
    return first, np.minimum(first + 1, length - 1), (position - first).astype(position.dtype)


def _sample_rows(image: Image, x: Image, y: Image) -> Image:
    """Return what `sample_bilinear` does for a few rows of positions, in NumPy."""
    height, width, channels = image.shape
    left, right, across = _split_position(x, width)
    top, bottom, down = _split_position(y, height)
    upper, lower = (row * width * channels for row in (top, bottom))
    left, right = left * channels, right * channels
    rows = (upper, lower) if down.any() else (upper,)
    columns = (left, right) if across.any() else (left,)
    corners = [[row + column for column in columns] for row in rows]
    flat = image.reshape(-1)
    found = np.empty((*x.shape, channels), image.dtype)
    for channel in range(channels):  # far faster than NumPy's loops over three values
        plane = flat[channel:]
        lines = [
            _interpolate_ends([plane.take(corner) for corner in row], across) for row in corners
        ]
        found[..., channel] = _interpolate_ends(lines, down)
    return found


def _interpolate_ends(ends: list[Image], share: Image) -> Image:
    """Return the value between two ends, or the only one where all is read at the first."""
    return ends[0] * (1 - share) + ends[1] * share if len(ends) > 1 else ends[0]


def sample_nearest(image: Image, x: Image, y: Image) -> Image:
    """Return a picture (H, W) read at the pixels nearest to fractional positions."""
    height, width = image.shape[:2]
    column = np.clip(np.floor(x + 0.5).astype(np.intp), 0, width - 1)
    row = np.clip(np.floor(y + 0.5).astype(np.intp), 0, height - 1)
    return np.asarray(image[row, column])


def sample_grid(
    channel: Image, x: NDArray[np.float64], y: NDArray[np.float64], into: Image
) -> None:
    """Read one channel (H, W) on a grid of columns x and rows y into ``into``, edges repeated.

    OpenCV's remap would take as long.
    """
    left, right, across = _split_position(x.astype(channel.dtype), channel.shape[1])
    top, bottom, down = _split_position(y.astype(channel.dtype), channel.shape[0])
    rest = 1 - across
    for start, stop in split_range(y.size, _GRID_ROWS):
        part, share = slice(start, stop), down[start:stop, None]
        rows, below = channel[top[part]], channel[bottom[part]]
        rows *= 1 - share
        below *= share
        rows += below
        found = np.take(rows, left, axis=1, mode="clip")  # all are inside: the fastest check
        found *= rest
        beside = np.take(rows, right, axis=1, mode="clip")
        beside *= across
        np.add(found, beside, out=into[part])
