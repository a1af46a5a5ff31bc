"""What picture figures are made of: sets of pictures from one scene, as arrays.

Every function returns plain arrays; words, frames and alt texts belong to the figures.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import groupby
from typing import cast

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.blocks import Tile, in_turn
from quizgen.camera.camera import Camera
from quizgen.camera.codes import histogram, rounded
from quizgen.camera.effects import demosaicing, gamma, mosaic
from quizgen.camera.effects.gaussian_noise import gaussian
from quizgen.camera.effects.impulse_noise import impulses
from quizgen.camera.effects.normalisation import stretch_range
from quizgen.camera.filters import convolve, everywhere_alike
from quizgen.camera.hsv import edit_hsv
from quizgen.camera.kernels import Kernel, disc
from quizgen.camera.noise import luck
from quizgen.camera.raster.draw import Box, blend, content, draw
from quizgen.camera.raster.uneven import wider
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


def focused(scene: Scene, depths: Sequence[float], *cameras: Camera) -> tuple[Codes, ...]:
    """Photographs of the things of a scene, each at a depth, by lenses of any focus and opening.

    What `photographs` takes of them, in less time: of what is drawn nothing depends on the depth,
    so it is kept, and of a camera only its lens and its tone curve are asked.

    Parameters
    ----------
    scene : Scene
        Things that stand still inside the frame, sized in px, before an even background.
    depths : sequence of float
        Of the things in their order, m.
    *cameras : Camera
        Each with a lens.
    """
    far_first = sorted(range(len(depths)), key=lambda thing: -depths[thing])
    groups = [(depth, tuple(some)) for depth, some in groupby(far_first, key=depths.__getitem__)]
    with everywhere_alike():
        return tuple(_focused(scene, groups, camera) for camera in cameras)


def _focused(
    scene: Scene, groups: Sequence[tuple[float, tuple[int, ...]]], camera: Camera
) -> Codes:
    view = View(scene, camera)
    encode = gamma.work(view)
    behind, even = _behind(scene, camera[gamma.GAMMA])
    light, seen = behind.copy(), even.copy()
    top, bottom = scene.height, 0
    for depth, some in groups:
        kernel = disc(view.blur_diameter(depth))
        part, keep, colour = (
            _blurred(scene, some, kernel) if kernel.size > 1 else _sharp(scene, some)
        )
        blend(light[part], keep, colour)
        top, bottom = min(top, part[0].start), max(bottom, part[0].stop)
    rows = light[top:bottom]
    encode(rows.reshape(-1), Tile(0, (slice(top, bottom),)))
    seen[top:bottom] = codes(rows)
    return seen


@lru_cache(maxsize=16)
def _behind(scene: Scene, tone: str | float) -> tuple[Image, Codes]:
    """The even background of a scene: its light, and its codes."""
    light = np.empty((scene.height, scene.width, 3), scene.precision)
    light[...] = scene.background
    encoded = in_turn(light, [gamma.work(View(scene, Camera(gamma=tone)))])[0]
    return light, codes(encoded)


Laid = tuple[Box, Image, Image]
"""Where the light of things gets, the share kept there of what is behind, and their colour."""


def _laid(part: Box, light: Image) -> Laid:
    return part, np.repeat(1.0 - light[..., 3:], 3, axis=2), light[..., :3]


@lru_cache(maxsize=16)
def _sharp(scene: Scene, some: tuple[int, ...]) -> Laid:
    image, box = _drawn(scene, some)
    return _laid(box, image[box])


def _blurred(scene: Scene, some: tuple[int, ...], kernel: Kernel) -> Laid:
    image, box = _drawn(scene, some)
    part = wider(box, (kernel.shape[0] // 2, kernel.shape[1] // 2), image.shape)
    return _laid(part, convolve(np.ascontiguousarray(image[part]), kernel))


@lru_cache(maxsize=16)
def _drawn(scene: Scene, some: tuple[int, ...]) -> tuple[Image, Box]:
    """Colour and cover of some things that share a depth, shape (H, W, 4), and where they are."""
    things = tuple(replace(scene.things[place], depth=1.0) for place in some)
    blurring = Camera(focal_length=0.05, pixel_pitch=1e-4, f_number=2.0)
    _, layer = draw(View(replace(scene, things=things), blurring))
    cover = cast("Image", layer.cover)  # there is something behind
    return np.concatenate([layer.colour, cover], axis=2), content(cover)
