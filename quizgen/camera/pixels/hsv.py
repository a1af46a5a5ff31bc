"""Hue, saturation and value of whole pictures in single precision.

`quizgen.numerics.hsv` goes back, in double precision and for any colour; the tests hold the two
together.
"""

from __future__ import annotations

import math
from types import ModuleType

import numpy as np
from numpy.typing import DTypeLike

from quizgen.camera.pixels.filters import load_opencv
from quizgen.camera.pixels.tiles import TILE_VALUES, Tile, TileOperation, apply_tilewise
from quizgen.camera.setup.scene import Image


def rgb_to_hsv(image: Image) -> Image:
    """Return hue in degrees [0, 360) (hexagonal), saturation and value in [0, 1].

    Parameters
    ----------
    image : numpy.ndarray
        Shape (..., 3), in [0, 1]. Greys get hue 0; black gets saturation 0.
    """
    cv2 = _find_opencv(image)
    if cv2 is not None:
        return np.asarray(cv2.cvtColor(np.ascontiguousarray(image), cv2.COLOR_RGB2HSV))

    def work(part: Image, _: Tile) -> None:
        """Convert the pixels of a tile in place."""
        part.reshape(-1, 3)[...] = _compute_hsv(part.reshape(-1, 3))

    return apply_tilewise(image.reshape(-1), [work])[0].reshape(image.shape)


def _find_opencv(image: Image) -> ModuleType | None:
    """Return OpenCV if it can convert this picture, else None: it knows no double precision."""
    return load_opencv() if image.ndim == 3 and image.dtype == np.float32 else None


def _compute_hsv(colours: Image) -> Image:
    """Return hue, saturation and value of colours, shape (..., 3)."""
    red, green, blue = colours.T
    value, least = colours.max(axis=1), colours.min(axis=1)
    chroma = value - least
    safe = np.where(chroma > 0, chroma, 1.0)
    hue = np.where(
        value == red,
        (green - blue) / safe,
        np.where(value == green, (blue - red) / safe + 2, (red - green) / safe + 4),
    )
    hue = np.where(hue < 0, hue + 6, hue) * 60.0
    hue = np.where((chroma > 0) & (hue < 360), hue, 0.0)
    saturation = chroma / np.where(value > 0, value, 1.0)
    return np.stack([hue, saturation, value], axis=1)


def _compute_rgb(image: Image) -> Image:
    """Return the colours of hue (in [0, 720) degrees), saturation and value, shape (..., 3)."""
    cv2 = _find_opencv(image)
    if cv2 is not None:
        return np.asarray(cv2.cvtColor(image, cv2.COLOR_HSV2RGB))
    hue, saturation, value = np.moveaxis(image, -1, 0)
    sextant = hue / 60.0
    parts = []
    for offset in (5.0, 3.0, 1.0):
        position = np.mod(sextant + offset, 6.0)
        weight = np.clip(np.minimum(position, 4 - position), 0, 1)
        parts.append(value - value * saturation * weight)
    return np.stack(parts, axis=-1)


def edit_hsv(image: Image, hue: float = 0.0, saturation: float = 1.0, value: float = 1.0) -> Image:
    """Return a picture with its hue turned, saturation and value scaled.

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
    return apply_tilewise(image, [hsv_operation(hue, saturation, value, image.dtype)])[0]


def hsv_operation(hue: float, saturation: float, value: float, kind: DTypeLike) -> TileOperation:
    """Return what does `edit_hsv` to a tile; ``kind`` is the type of its values."""
    steps = (
        _repeat_colour(1.0, saturation, value, kind),
        _repeat_colour(math.fmod(math.fmod(hue, 360.0) + 360.0, 360.0), 0.0, 0.0, kind),
        _repeat_colour(math.inf, 1.0, 1.0, kind),
    )

    def work(part: Image, _: Tile) -> None:
        """Edit the pixels of a tile in place."""
        edited = rgb_to_hsv(np.clip(part, 0.0, 1.0).reshape(1, -1, 3))
        flat = edited.reshape(-1)
        factors, shift, most = (step[: flat.size] for step in steps)
        flat *= factors
        flat += shift
        np.minimum(flat, most, out=flat)
        part[...] = _compute_rgb(edited).reshape(-1)

    return work


def _repeat_colour(first: float, second: float, third: float, kind: DTypeLike) -> Image:
    """Return three numbers repeated to the length of a tile, as one row of values."""
    return np.tile(np.asarray([first, second, third], kind), TILE_VALUES // 3)
