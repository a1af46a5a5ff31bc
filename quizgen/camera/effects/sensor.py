"""Effects of the sensor: functions on one linear picture (H, W, 3), 1 = full well = white."""

# ruff: noqa: ARG001 - every effect and every bound takes the same arguments

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.effects.base import stream
from quizgen.camera.scene import Image, View

Field = NDArray[np.float64]

_PART = 1 << 15

CHANNELS = {"R": 0, "G": 1, "B": 2}


def _bands(shape: tuple[int, ...]) -> Iterator[slice]:
    """Rows in bands that stay in the processor's cache."""
    rows = max(1, _PART // math.prod(shape[1:]))
    for start in range(0, shape[0], rows):
        yield slice(start, start + rows)


# Light fall-off and exposure


def rim_overlap(shift: Any) -> Any:
    """Area shared by two equal discs, as a share of one, at a shift in diameters (0 to 1)."""
    half = np.clip(shift, 0.0, 1.0)
    return (2.0 / math.pi) * (np.arccos(half) - half * np.sqrt(1.0 - half * half))


def fall_off(radius: Any, view: View) -> Any:
    """Share of light kept at a distance from the principal point, px.

    Natural: cos^4 of the field angle, (1 + (r/f)^2)^-2. Mechanical: lens rim and aperture as two
    discs that slide apart, by ``mechanical_vignetting`` diameters at the corner.
    """
    camera = view.camera
    kept = 1.0 / (1.0 + (radius / view.focal) ** 2) ** 2 if camera.natural_vignetting else 1.0
    if camera.mechanical_vignetting:
        kept = kept * rim_overlap(camera.mechanical_vignetting * radius / view.corner)
    return kept


def fall_off_map(view: View) -> Image:
    """`fall_off` at every pixel, shape (H, W, 1)."""
    camera = view.camera
    focal = view.focal if camera.natural_vignetting else 0.0
    return _fall_off_map(view.width, view.height, focal, camera.mechanical_vignetting)


@lru_cache(maxsize=2)
def _fall_off_map(width: int, height: int, focal: float, mechanical: float) -> Image:
    """One quadrant, mirrored."""
    x, y = (width - 1) / 2, (height - 1) / 2
    right, lower = np.arange((width + 1) // 2) - x, np.arange((height + 1) // 2) - y
    squared = right[None, :] ** 2 + lower[:, None] ** 2
    kept: Field = 1.0 / (1.0 + squared / focal**2) ** 2 if focal else np.ones_like(squared)
    if mechanical:
        kept = kept * rim_overlap(mechanical * np.sqrt(squared) / math.hypot(x, y))
    kept = np.concatenate([kept, kept[:, width // 2 - 1 :: -1]], axis=1)
    kept = np.concatenate([kept, kept[height // 2 - 1 :: -1]], axis=0)
    return kept.astype(np.float32)[..., None]


def vignetting(image: Image, view: View, rung: str = "") -> Image:
    """Multiply by the fall-off map."""
    return image * fall_off_map(view)


def exposure(image: Image, view: View, rung: str = "") -> Image:
    """Multiply by 2^stops."""
    return image * np.float32(2.0**view.camera.exposure)


# Noise


def _well(view: View) -> float:
    return view.camera.full_well or math.inf


FEW_ELECTRONS = 16.18
"""Below this mean, counts are looked up one by one."""


def poisson_quantiles(mean: Field, normal: Field) -> Field:
    """Poisson counts at the probabilities of standard normal values.

    One normal value per pixel makes the counts grow with the mean, so that a rounding error in one
    pixel cannot change its neighbours, and a Gaussian rung sees the same luck.

    Parameters
    ----------
    mean, normal : numpy.ndarray
        Same shape, float64; mean >= 0.

    Returns
    -------
    numpy.ndarray
        Whole numbers. The distribution function is within 2e-5 of Poisson's: the expansion of its
        inverse in 1/sqrt(mean) (M. Giles, Algorithm 955), exact counting below `FEW_ELECTRONS`.
    """
    enough = np.maximum(mean, FEW_ELECTRONS)
    root, square = np.sqrt(enough), normal * normal
    first = 1.0 / 3.0 + square / 6.0
    second = normal * (-1.0 / 36.0 - square / 72.0)
    third = -8.0 / 405.0 + square * (7.0 / 810.0 + square / 270.0)
    counts = np.floor(enough + root * normal + first + (second + third / root) / root)
    np.maximum(counts, 0.0, out=counts)
    few = mean < FEW_ELECTRONS
    if few.any():
        counts[few] = _counted(mean[few], normal[few])
    return counts


def _counted(mean: Field, normal: Field) -> Field:
    """How many steps of the distribution function lie below each probability."""
    below = _normal_below(normal)
    chance = np.exp(-mean)
    reached, counts = chance.copy(), np.zeros_like(mean)
    for count in range(1, 80):
        more = below > reached
        if not more.any():
            break
        counts += more
        chance *= mean / count
        reached += chance
    return counts


def _normal_below(normal: Field) -> Field:
    """Normal distribution function within 1e-7 (Abramowitz and Stegun 26.2.17)."""
    t = 1.0 / (1.0 + 0.2316419 * np.abs(normal))
    series = 0.31938153 + t * (
        -0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429))
    )
    tail = t * series * np.exp(-normal * normal / 2.0) / math.sqrt(2.0 * math.pi)
    return np.where(normal < 0.0, tail, 1.0 - tail)


def shot_noise(image: Image, view: View, rung: str = "") -> Image:
    """Electrons arrive at random: Poisson with mean (signal times full well).

    Parameters
    ----------
    image : numpy.ndarray
        Linear, >= 0.
    view : View
    rung : str
        ``gaussian`` uses the normal law with the same mean and variance (errata E23).
    """
    source, result, well = stream(view, "shot noise"), np.empty_like(image), _well(view)
    for rows in _bands(image.shape):
        signal = np.maximum(image[rows], np.float32(0.0))
        normal = source.standard_normal(signal.shape, np.float32)
        if rung == "gaussian":
            result[rows] = signal + np.sqrt(signal * np.float32(1.0 / well)) * normal
        else:
            mean = signal.astype(np.float64) * well
            result[rows] = poisson_quantiles(mean, normal.astype(np.float64)) / well
    return result


def _add_normal(image: Image, sigma: float, source: np.random.Generator) -> Image:
    result = np.empty_like(image)
    for rows in _bands(image.shape):
        spread = source.standard_normal(image[rows].shape, np.float32)
        spread *= np.float32(sigma)
        np.add(image[rows], spread, out=result[rows])
    return result


def dark_electrons(view: View) -> float:
    """Mean dark charge per photosite, e-: current times exposure time."""
    return view.camera.dark_current * view.camera.shutter


def _poisson(mean: float, shape: tuple[int, ...], source: np.random.Generator) -> Image:
    """Poisson counts of one mean, by looking uniform numbers up in the distribution's table."""
    first = max(0, math.floor(mean - 12.0 * math.sqrt(mean) - 20.0))
    last = math.ceil(mean + 12.0 * math.sqrt(mean) + 40.0)
    chances = [
        math.exp(count * math.log(mean) - mean - math.lgamma(count + 1.0))
        for count in range(first, last)
    ]
    below, counts = np.cumsum(chances), np.empty(shape, np.float32)
    for rows in _bands(shape):
        counts[rows] = np.searchsorted(below, source.random(counts[rows].shape), side="right")
    return counts + np.float32(first)


def dark_current(image: Image, view: View, rung: str = "") -> Image:
    """Add the dark charge and its own shot noise; hot pixels are stuck at full well."""
    source, result = stream(view, "dark current"), image
    electrons = dark_electrons(view)
    if electrons:
        charge = _poisson(electrons, image.shape, source) * np.float32(1.0 / _well(view))
        result = image + charge
    if view.camera.hot_pixels:
        hot = source.random(image.shape[:2]) < view.camera.hot_pixels
        result = np.where(hot[..., None], np.float32(1.0), result)
    return result


def read_noise(image: Image, view: View, rung: str = "") -> Image:
    """Add normal noise of the read-out chain, sigma in electrons."""
    return _add_normal(image, view.camera.read_noise / _well(view), stream(view, "read noise"))


# Too much light


def blooming(image: Image, view: View, rung: str = "") -> Image:
    """Charge above the full well spills along the column, half up and half down.

    Each photosite keeps what it can; what reaches the border is drained.
    """
    half = np.maximum(image - np.float32(1.0), np.float32(0.0)) * np.float32(0.5)
    kept = np.minimum(image, np.float32(1.0))
    return _spill(_spill(kept, half)[::-1], half[::-1])[::-1]


def _spill(kept: Image, excess: Image) -> Image:
    """Carry excess to the next rows until it finds room."""
    filled, carried = kept.copy(), np.zeros(kept.shape[1:], np.float32)
    for row in range(kept.shape[0]):
        level = filled[row] + carried
        filled[row] = np.minimum(level, np.float32(1.0))
        carried = level - filled[row] + excess[row]
    return filled


def smear(image: Image, view: View, rung: str = "") -> Image:
    """Light that falls in while a CCD shifts its rows: a share of each column's mean."""
    mean = image.mean(axis=0, keepdims=True, dtype=np.float64)
    return np.asarray(image + (view.camera.smear * mean).astype(np.float32))


def full_well(image: Image, view: View, rung: str = "") -> Image:
    """A photosite holds no more than its full well."""
    return np.minimum(image, np.float32(1.0))


# Mosaic and converter


def colour_at(view: View) -> tuple[tuple[int, int], ...]:
    """Channel at each place of the 2x2 tile, as rows of columns."""
    tile = [CHANNELS[letter] for letter in view.camera.mosaic]
    return (tile[0], tile[1]), (tile[2], tile[3])


def mosaic(image: Image, view: View, rung: str = "") -> Image:
    """Keep one colour per photosite, shape (H, W, 1)."""
    raw = np.empty((*image.shape[:2], 1), np.float32)
    for row, channels in enumerate(colour_at(view)):
        for column, channel in enumerate(channels):
            raw[row::2, column::2, 0] = image[row::2, column::2, channel]
    return raw


def levels(bits: int) -> int:
    """Largest code of a converter."""
    return int(2**bits - 1)


def quantise(image: Image, view: View, rung: str = "") -> Image:
    """Clip to [0, 1] and round to the converter's codes, halves upward."""
    top = np.float32(levels(view.camera.bit_depth or 16))
    scaled = image * top
    scaled += np.float32(0.5)
    np.floor(scaled, out=scaled)
    np.clip(scaled, np.float32(0.0), top, out=scaled)
    scaled /= top
    return scaled
