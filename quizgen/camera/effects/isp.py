"""What is done to the raw data, and the edits of finished pictures."""

# ruff: noqa: ARG001 - every effect and every bound takes the same arguments

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.blocks import BLOCK, pointwise
from quizgen.camera.effects.base import stream
from quizgen.camera.effects.sensor import CHANNELS, colour_at, fall_off_map
from quizgen.camera.filters import opencv
from quizgen.camera.power import encode, encode_by_table
from quizgen.camera.scene import Image, View


def demosaic(raw: Image, view: View, rung: str = "") -> Image:
    """Bilinear interpolation of a mosaic.

    Parameters
    ----------
    raw : numpy.ndarray
        Shape (H, W, 1), H and W >= 2. The border is mirrored without repeating the edge, so that
        every neighbour keeps its colour (errata EC7).
    view : View
        Camera with a mosaic.
    """
    if raw.shape[2] != 1:
        return raw
    plane = np.pad(raw[..., 0], 1, mode="reflect")
    return bilinear(plane, colour_at(view))


def bilinear(plane: Image, tile: tuple[tuple[int, int], ...]) -> Image:
    """Means of the nearest photosites of each colour, from a plane padded by one."""
    height, width = plane.shape[0] - 2, plane.shape[1] - 2
    result = np.empty((height, width, 3), np.float32)
    for row in (0, 1):
        for column in (0, 1):
            site = _neighbours(plane, row, column, height, width)
            for channel in range(3):
                where = _same_colour(tile, row, column, channel)
                result[row::2, column::2, channel] = site[where]
    return result


def _neighbours(
    plane: Image, row: int, column: int, height: int, width: int
) -> dict[str, NDArray[np.float32]]:
    def at(down: int, across: int) -> Image:
        top, left = row + 1 + down, column + 1 + across
        return plane[top : top + height - row : 2, left : left + width - column : 2]

    level, upright = at(0, -1) + at(0, 1), at(-1, 0) + at(1, 0)
    corners = (at(-1, -1) + at(-1, 1)) + (at(1, -1) + at(1, 1))
    half, quarter = np.float32(0.5), np.float32(0.25)
    return {
        "here": at(0, 0),
        "level": level * half,
        "upright": upright * half,
        "cross": (level + upright) * quarter,
        "corners": corners * quarter,
    }


def _same_colour(tile: tuple[tuple[int, int], ...], row: int, column: int, channel: int) -> str:
    """Where a colour is found around a place of the tile."""
    here, beside = tile[row][column], tile[row][1 - column]
    if here == channel:
        return "here"
    if channel == CHANNELS["G"]:
        return "cross"
    if here != CHANNELS["G"]:
        return "corners"
    return "level" if beside == channel else "upright"


def rounded(values: NDArray[np.floating[Any]]) -> NDArray[np.uint8]:
    """8-bit codes of values in [0, 255]: clipped, halves rounded upward (as OpenCV's demosaicing).

    Nothing is truncated (errata EC8) and nothing wraps (errata E21).
    """
    return np.asarray(np.clip(np.floor(values + 0.5), 0, 255), np.uint8)


def flat_field(image: Image, view: View, rung: str = "") -> Image:
    """Divide out the vignetting of an even picture: linear data, mean brightness kept (E31)."""
    flat = fall_off_map(view)
    return correct_flat(image, flat, np.float32(0.0))


def correct_flat(raw: Image, flat: Image, dark: Image | np.float32) -> Image:
    """Flat-field correction (raw - dark)/(flat - dark) times the mean of (flat - dark).

    Parameters
    ----------
    raw, flat, dark : numpy.ndarray
        Linear pictures of the scene, of an even surface, and with the lens covered.

    Raises
    ------
    ValueError
        If a flat pixel is not brighter than its dark value (a dead pixel has no correction).
    """
    light = flat - dark
    if light.min() <= 0:
        raise ValueError("a flat pixel is not brighter than the dark frame")
    return (raw - dark) * (np.float32(light.mean(dtype=np.float64)) / light)


def white_balance(image: Image, view: View, rung: str = "") -> Image:
    """Multiply the channels by their gains."""
    return image * np.asarray(view.camera.white_balance, np.float32)


def gamma(image: Image, view: View, rung: str = "") -> Image:
    """Encode linear light for display; clips to [0, 1]. The rung ``table`` rounds to 16 bits."""
    if rung == "table":
        return encode_by_table(image, view.camera.gamma)
    return encode(image, view.camera.gamma)


# Hue, saturation, value


def rgb_to_hsv(image: Image) -> Image:
    """Hexagonal hue in degrees [0, 360), saturation and value in [0, 1].

    Parameters
    ----------
    image : numpy.ndarray
        Shape (..., 3), in [0, 1]. Greys get hue 0; black gets saturation 0.
    """
    cv2: Any = opencv()
    if cv2 is not None and image.ndim == 3:
        return np.asarray(cv2.cvtColor(np.ascontiguousarray(image), cv2.COLOR_RGB2HSV))

    def work(part: Image, out: Image) -> None:
        out.reshape(-1, 3)[...] = _hsv_part(part.reshape(-1, 3))

    return pointwise(image, work)


def _hsv_part(colours: Image) -> Image:
    red, green, blue = colours.T
    value, least = colours.max(axis=1), colours.min(axis=1)
    chroma = value - least
    safe = np.where(chroma > 0, chroma, np.float32(1.0))
    hue = np.where(
        value == red,
        (green - blue) / safe,
        np.where(value == green, (blue - red) / safe + 2, (red - green) / safe + 4),
    )
    hue = np.where(hue < 0, hue + 6, hue) * np.float32(60.0)
    hue = np.where((chroma > 0) & (hue < 360), hue, np.float32(0.0))
    saturation = chroma / np.where(value > 0, value, np.float32(1.0))
    return np.stack([hue, saturation, value], axis=1)


def hsv_to_rgb(image: Image) -> Image:
    """Inverse of `rgb_to_hsv`; any finite hue in degrees, taken modulo 360."""
    turned = image.copy()
    np.mod(turned[..., 0], np.float32(360.0), out=turned[..., 0])
    return _to_rgb(turned)


def _to_rgb(image: Image) -> Image:
    """Colours of hues in [0, 720) degrees."""
    cv2: Any = opencv()
    if cv2 is not None and image.ndim == 3:
        return np.asarray(cv2.cvtColor(image, cv2.COLOR_HSV2RGB))
    hue, saturation, value = np.moveaxis(image, -1, 0)
    sextant = hue / np.float32(60.0)
    parts = []
    for offset in (5.0, 3.0, 1.0):
        position = np.mod(sextant + np.float32(offset), np.float32(6.0))
        weight = np.clip(np.minimum(position, 4 - position), 0, 1)
        parts.append(value - value * saturation * weight)
    return np.stack(parts, axis=-1)


def edit_hsv(image: Image, hue: float = 0.0, saturation: float = 1.0, value: float = 1.0) -> Image:
    """Turn the hue, scale saturation and value.

    Parameters
    ----------
    image : numpy.ndarray
        Shape (H, W, 3), in [0, 1].
    hue : float
        Degrees to add.
    saturation, value : float
        Factors; results are clipped to 1. Value stays when only hue or saturation change, the
        luminance does not (errata E04, E05).
    """
    steps = (
        _colours(1.0, saturation, value),
        _colours(math.fmod(math.fmod(hue, 360.0) + 360.0, 360.0), 0.0, 0.0),
        _colours(math.inf, 1.0, 1.0),
    )
    return pointwise(image, lambda part, out: _edit_part(part, out, steps))


def _colours(first: float, second: float, third: float) -> Image:
    """One colour, repeated to the length of a piece."""
    return np.tile(np.asarray([first, second, third], np.float32), BLOCK // 3)


def _edit_part(part: Image, out: Image, steps: tuple[Image, Image, Image]) -> None:
    colours = np.clip(part, np.float32(0.0), np.float32(1.0)).reshape(1, -1, 3)
    edited = rgb_to_hsv(colours)
    flat = edited.reshape(-1)
    factors, shift, most = (step[: flat.size] for step in steps)
    flat *= factors
    flat += shift
    np.minimum(flat, most, out=flat)
    out[...] = _to_rgb(edited).reshape(-1)


def hsv_edit(image: Image, view: View, rung: str = "") -> Image:
    """`edit_hsv` with the camera's parameters."""
    camera = view.camera
    return edit_hsv(image, math.degrees(camera.hue), camera.saturation, camera.value)


# Noise and range


def add_gaussian(image: Image, sigma: float, source: np.random.Generator) -> Image:
    """Add normal noise, then clip to [0, 1] (black gains 0.399 sigma on average, errata E39).

    Parameters
    ----------
    image : numpy.ndarray
        In [0, 1], float32.
    sigma : float
        Standard deviation, 1 = white.
    source : numpy.random.Generator
        Passed in, never shared between calls (errata EC5).
    """
    noise = source.standard_normal(image.shape, np.float32)
    noise *= np.float32(sigma)
    noise += image
    return np.clip(noise, np.float32(0.0), np.float32(1.0), out=noise)


def gaussian_noise(image: Image, view: View, rung: str = "") -> Image:
    """`add_gaussian` with the camera's sigma."""
    return add_gaussian(image, view.camera.gaussian_noise, stream(view, "gaussian noise"))


def add_impulses(image: Image, share: float, source: np.random.Generator) -> Image:
    """Salt and pepper: each pixel turns black or white with probability share/2 each.

    Parameters
    ----------
    image : numpy.ndarray
        Shape (H, W, C); all channels of a pixel are hit together (errata EC6).
    share : float
        In [0, 1]; more would let salt overwrite pepper.
    source : numpy.random.Generator
    """
    if not 0.0 <= share <= 1.0:
        raise ValueError("the share of impulses lies in [0, 1]")
    draw = source.random(image.shape[:2])[..., None]
    pepper = np.where(draw < share / 2, np.float32(0.0), image)
    return np.where(draw >= 1.0 - share / 2, np.float32(1.0), pepper)


def impulse_noise(image: Image, view: View, rung: str = "") -> Image:
    """`add_impulses` with the camera's share."""
    return add_impulses(image, view.camera.impulse_noise, stream(view, "impulse noise"))


def stretch_range(
    image: Image, low: float, high: float, new_low: float = 0.0, new_high: float = 1.0
) -> Image:
    """Normalise [low, high] to [new_low, new_high] and clip to it on both sides (errata E44)."""
    share = (image - np.float32(low)) * np.float32(1.0 / (high - low))
    np.clip(share, np.float32(0.0), np.float32(1.0), out=share)
    share *= np.float32(new_high - new_low)
    share += np.float32(new_low)
    return share


def normalise(image: Image, view: View, rung: str = "") -> Image:
    """`stretch_range` with the camera's limits."""
    return stretch_range(image, *(view.camera.normalise or (0.0, 1.0, 0.0, 1.0)))


def histogram(image: NDArray[Any], bins: int = 256, top: float = 1.0) -> NDArray[np.int64]:
    """Counts of values in equal bins over [0, top]; values outside fall into the end bins.

    Parameters
    ----------
    image : numpy.ndarray
        Any shape. With integer pictures use ``top = 255`` and 256 bins: one bin per level.
    """
    steps = bins - 1 if np.issubdtype(image.dtype, np.integer) else bins
    index = np.clip((image.astype(np.float64) * (steps / top)).astype(np.int64), 0, bins - 1)
    return np.bincount(index.reshape(-1), minlength=bins)
