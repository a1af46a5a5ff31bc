"""What picture figures are made of: sets of pictures from one scene, as arrays.

Every function returns plain arrays; words, frames and alt texts belong to the figures.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.blocks import in_turn
from quizgen.camera.camera import Camera
from quizgen.camera.codes import histogram, rounded
from quizgen.camera.effects import demosaicing, mosaic
from quizgen.camera.effects.gaussian_noise import gaussian
from quizgen.camera.effects.impulse_noise import impulses
from quizgen.camera.effects.normalisation import stretch_range
from quizgen.camera.hsv import edit_hsv
from quizgen.camera.noise import luck
from quizgen.camera.scene import Image, Scene
from quizgen.camera.view import View

Codes = NDArray[np.uint8]


def codes(image: Image) -> Codes:
    """8-bit codes of a finished picture in [0, 1], halves rounded upward."""
    return rounded(image * 255.0)


def hsv_edits(image: Image, value: float, saturation: float, hue: float) -> tuple[Image, ...]:
    """The original, V times a factor, S times a factor, and H plus degrees, in this order."""
    return (
        image,
        edit_hsv(image, value=value),
        edit_hsv(image, saturation=saturation),
        edit_hsv(image, hue=hue),
    )


def noisy(image: Image, sigma: float, share: float, seed: int) -> tuple[Image, Image, Image]:
    """Clean, with Gaussian noise, with salt and pepper; each noise has its own stream."""
    height, width = image.shape[:2]
    view = View(Scene(width, height, image=image, seed=seed), Camera())
    grainy = gaussian(sigma, luck(view, "gaussian noise"))
    spotted = impulses(share, luck(view, "impulse noise"))
    return image, in_turn(image, [grainy])[0], in_turn(image, [spotted])[0]


def bayer(image: Image, phase: str = "RGGB") -> tuple[Image, Image, Image]:
    """A mosaic and what bilinear interpolation makes of it.

    Returns
    -------
    raw : numpy.ndarray
        Shape (H, W), one value per photosite.
    coloured : numpy.ndarray
        Shape (H, W, 3), the same with each value in its own channel.
    full : numpy.ndarray
        Shape (H, W, 3), interpolated.
    """
    height, width = image.shape[:2]
    view = View(Scene(width, height, image=image), Camera(mosaic=phase))
    raw = mosaic.run(image, view)
    coloured = np.zeros((height, width, 3), raw.dtype)
    for row, channels in enumerate(mosaic.colour_at(view)):
        for column, channel in enumerate(channels):
            coloured[row::2, column::2, channel] = raw[row::2, column::2, 0]
    return raw[..., 0], coloured, demosaicing.run(raw, view)


def normalised(
    image: Image, low: float, high: float, bins: int = 64
) -> tuple[Image, NDArray[np.int64], NDArray[np.int64]]:
    """A picture stretched from [low, high] to [0, 1], and the histograms before and after."""
    after = stretch_range(image, low, high)
    return after, histogram(image, bins), histogram(after, bins)
