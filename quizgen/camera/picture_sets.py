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

from quizgen.camera.camera import Camera
from quizgen.camera.effects import gamma
from quizgen.camera.effects.gaussian_noise import add_gaussian
from quizgen.camera.effects.impulse_noise import add_impulses
from quizgen.camera.effects.normalisation import stretch_range
from quizgen.camera.pixels.codes import count_histogram, to_8bit
from quizgen.camera.pixels.filters import convolve, numpy_only
from quizgen.camera.pixels.hsv import edit_hsv
from quizgen.camera.pixels.kernels import BlurKernel, disc_kernel
from quizgen.camera.pixels.noise import effect_random
from quizgen.camera.pixels.tiles import Tile, apply_tilewise
from quizgen.camera.raster.rasterizer import PixelBox, blend_into, bounding_box, grow_box, rasterize
from quizgen.camera.setup.scene import Image, Scene
from quizgen.camera.setup.view import View

Codes = NDArray[np.uint8]


def to_codes(image: Image) -> Codes:
    """Return the 8-bit codes of a finished picture in [0, 1], halves rounded upward."""
    return to_8bit(image * 255.0)


def make_hsv_edits(image: Image, value: float, saturation: float, hue: float) -> tuple[Image, ...]:
    """Return four pictures: the original, value scaled, saturation scaled, hue turned (degrees)."""
    return (
        image,
        edit_hsv(image, value=value),
        edit_hsv(image, saturation=saturation),
        edit_hsv(image, hue=hue),
    )


def make_noisy(image: Image, sigma: float, share: float, seed: int) -> tuple[Image, Image, Image]:
    """Return three pictures: clean, with Gaussian noise, with salt and pepper noise.

    Each noise has a stream of its own.
    """
    height, width = image.shape[:2]
    view = View(Scene(width, height, image=image, seed=seed), Camera())
    grainy = add_gaussian(sigma, effect_random(view, "gaussian noise"))
    spotted = add_impulses(share, effect_random(view, "impulse noise"))
    return image, apply_tilewise(image, [grainy])[0], apply_tilewise(image, [spotted])[0]


def make_normalised(
    image: Image, low: float, high: float, bins: int = 64
) -> tuple[Image, NDArray[np.int64], NDArray[np.int64]]:
    """Return a picture stretched from [low, high] to [0, 1], and histograms before and after."""
    after = stretch_range(image, low, high)
    return after, count_histogram(image, bins), count_histogram(after, bins)


def make_focused(scene: Scene, depths: Sequence[float], *cameras: Camera) -> tuple[Codes, ...]:
    """Return one photograph for each camera, of the things of a scene at these depths.

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
    with numpy_only():
        return tuple(_focus_on_depth(scene, groups, camera) for camera in cameras)


def _focus_on_depth(
    scene: Scene, groups: Sequence[tuple[float, tuple[int, ...]]], camera: Camera
) -> Codes:
    """Return the photograph of one camera; groups of things are given far ones first.

    A group is a depth in m, and the indices of the things there.
    """
    view = View(scene, camera)
    encode = gamma.operation(view)
    behind, even = _encode_background(scene, camera[gamma.GAMMA])
    light, seen = behind.copy(), even.copy()
    top, bottom = scene.height, 0
    for depth, some in groups:
        kernel = disc_kernel(view.blur_diameter(depth))
        part, keep, colour = (
            _blur_things(scene, some, kernel) if kernel.size > 1 else _rasterize_sharp(scene, some)
        )
        blend_into(light[part], keep, colour)
        top, bottom = min(top, part[0].start), max(bottom, part[0].stop)
    rows = light[top:bottom]
    encode(rows.reshape(-1), Tile(0, (slice(top, bottom),)))
    seen[top:bottom] = to_codes(rows)
    return seen


@lru_cache(maxsize=16)
def _encode_background(scene: Scene, tone: str | float) -> tuple[Image, Codes]:
    """Return the even background of a scene, as linear light and as 8-bit codes."""
    light = np.empty((scene.height, scene.width, 3), scene.precision)
    light[...] = scene.background
    encoded = apply_tilewise(light, [gamma.operation(View(scene, Camera(gamma=tone)))])[0]
    return light, to_codes(encoded)


LaidLight = tuple[PixelBox, Image, Image]
"""Where the light of things gets, the share kept there of what is behind, and their colour."""


def _split_coverage(part: PixelBox, light: Image) -> LaidLight:
    """Return box, share of the background kept there, and colour, from colour with coverage."""
    return part, np.repeat(1.0 - light[..., 3:], 3, axis=2), light[..., :3]


@lru_cache(maxsize=16)
def _rasterize_sharp(scene: Scene, some: tuple[int, ...]) -> LaidLight:
    """Return what `_split_coverage` does for some things, unblurred and cached."""
    image, box = _rasterize_things(scene, some)
    return _split_coverage(box, image[box])


def _blur_things(scene: Scene, some: tuple[int, ...], kernel: BlurKernel) -> LaidLight:
    """Return what `_split_coverage` does for some things, blurred by a kernel."""
    image, box = _rasterize_things(scene, some)
    part = grow_box(box, (kernel.shape[0] // 2, kernel.shape[1] // 2), image.shape)
    return _split_coverage(part, convolve(np.ascontiguousarray(image[part]), kernel))


@lru_cache(maxsize=16)
def _rasterize_things(scene: Scene, some: tuple[int, ...]) -> tuple[Image, PixelBox]:
    """Return colour and coverage of some things, shape (H, W, 4), and the box that they cover."""
    things = tuple(replace(scene.things[place], depth=1.0) for place in some)
    blurring = Camera(focal_length=0.05, pixel_pitch=1e-4, f_number=2.0)
    _, layer = rasterize(View(replace(scene, things=things), blurring))
    cover = cast("Image", layer.cover)  # there is something behind
    return np.concatenate([layer.colour, cover], axis=2), bounding_box(cover)
