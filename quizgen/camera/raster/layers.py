"""Layers that are moved or resampled, and what an error in one of them can show."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import product

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from quizgen.camera.pixels.filters import convolve, sample_bilinear
from quizgen.camera.pixels.kernels import BlurKernel
from quizgen.camera.pixels.tiles import split_range
from quizgen.camera.raster.rasterizer import (
    Layer,
    LayerSpec,
    Motion,
    PixelBox,
    bounding_box,
    extends_beyond_frame,
    full_box,
    grow_box,
    intersect_boxes,
    layer_specs,
)
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import VELOCITY
from quizgen.camera.setup.view import Signal, View

Field = NDArray[np.float64]


RegionMaker = Callable[[list[Image], PixelBox], list[Image]]
"""Makes colour and, but for an opaque layer, cover of a box again."""

_ROWS, _COLUMNS = 256, 1024
"""Made at once, so that what lies in between stays small; more where a kernel is wide."""


def remake_layer(
    layer: Layer,
    reach: tuple[int, int],
    make: RegionMaker,
    most: tuple[int, int] = (_ROWS, sys.maxsize),
    within: PixelBox | None = None,
) -> Layer:
    """Return a layer of which ``make`` computes all that its content can reach, band by band.

    Parameters
    ----------
    layer : Layer
    reach : (int, int)
        Rows and columns that light gets from its pixel.
    make : callable
        Gets colour and cover and what is wanted of them.
    most : (int, int)
        Rows and columns that are made at once, so that what lies in between stays small.
    within : (slice, slice), optional
        A box outside which nothing changes.
    """
    whole = full_box(layer.colour.shape)
    changed = intersect_boxes(
        grow_box(content_box(layer), reach, layer.colour.shape), within or whole
    )
    if changed is None:
        return layer
    images = [layer.colour] if layer.cover is None else [layer.colour, layer.cover]
    results = images if layer.own else [_copy_image(image, layer, changed) for image in images]
    made: list[MadeRegion] = []
    for box in _split_box(changed, most):
        # nothing may be written over while others still look at it
        done = box[0].start - (reach[0] if results is images else 0)
        _write_regions((one for one in made if one[0][0].stop <= done), results)
        made = [one for one in made if one[0][0].stop > done]
        made.append((box, make(images, box)))
    _write_regions(made, results)
    cover = None if layer.cover is None else results[1]
    return replace(layer, colour=results[0], cover=cover, own=True)


MadeRegion = tuple[PixelBox, list[Image]]


def _write_regions(made: Iterable[MadeRegion], results: list[Image]) -> None:
    """Copy computed regions into the results: colour and, if there is one, coverage."""
    for box, parts in made:
        for result, part in zip(results, parts, strict=True):
            result[box] = part


def _copy_image(image: Image, layer: Layer, changed: PixelBox) -> Image:
    """Return a copy of what stays of an image; empty parts take no memory."""
    if image[changed].shape == image.shape:
        return np.empty(image.shape, image.dtype)
    if layer.cover is None:
        return image.copy()
    result: Image = np.zeros(image.shape, image.dtype)
    there = bounding_box(layer.cover)
    result[there] = image[there]
    return result


def _split_box(box: PixelBox, most: tuple[int, int]) -> Iterator[PixelBox]:
    """Yield a box cut into pieces of at most so many rows and columns, from the top."""
    rows, columns = box
    for top, bottom in split_range(rows.stop - rows.start, most[0]):
        for left, right in split_range(columns.stop - columns.start, most[1]):
            down = slice(rows.start + top, rows.start + bottom)
            yield down, slice(columns.start + left, columns.start + right)


def sampling_reach(layer: Layer, far: tuple[float, float]) -> tuple[int, int]:
    """Return the rows and columns that sampling so far (across, down, px) from a pixel reads."""
    sides = layer.colour.shape[1::-1]
    across, down = (math.ceil(min(one, side)) + 1 for one, side in zip(far, sides, strict=True))
    return down, across


def content_box(layer: Layer) -> PixelBox:
    """Return the box outside which a layer is empty."""
    return full_box(layer.colour.shape) if layer.cover is None else bounding_box(layer.cover)


def blur_layer(layer: Layer, kernel: BlurKernel) -> Layer:
    """Return a layer convolved with a kernel, colour and coverage together."""
    if kernel.size == 1:
        return layer
    down, across = (side // 2 for side in kernel.shape)

    def blur(images: list[Image], box: PixelBox) -> list[Image]:
        """Return the convolved images of a box."""
        seen = grow_box(box, (down, across), images[0].shape)
        top, left = (part.start - more.start for part, more in zip(box, seen, strict=True))
        light = [image[seen] for image in images]
        found = convolve(light[0] if len(light) == 1 else np.concatenate(light, axis=2), kernel)
        found = found[top:, left:][: box[0].stop - box[0].start, : box[1].stop - box[1].start]
        channels = images[0].shape[2]
        return [found[..., :channels], found[..., channels:]][: len(images)]

    most = max(_ROWS, 16 * down), max(_COLUMNS, 32 * across)
    return remake_layer(layer, (down, across), blur, most)


def bound_layers(signal: Signal, view: View, share: Callable[[LayerSpec], float]) -> float:
    """Return a bound on what a picture shows of an averaging error in its layers.

    An error of a layer shows as at most that of its colour plus half the range times that of its
    cover: one range in an opaque layer, one and a half in others. No average leaves the range.

    Parameters
    ----------
    signal : Signal
    view : View
    share : callable
        How far any value of a layer may be off, by its own range.
    """
    shares = (share(spec) * (1.0 if spec.opaque else 1.5) for spec in layer_specs(view))
    return signal.span * min(sum(shares), 1.0)


def bound_shift(signal: Signal, view: View, distance: float) -> float:
    """Return a bound on what reading every layer ``distance`` px away changes.

    Neighbouring pixels may be black and white.
    """
    far = math.sqrt(2.0) * (distance + position_error(view))
    return bound_layers(signal, view, lambda _: far)


def largest_margin(
    view: View, reach: Callable[[LayerSpec], tuple[float, float]]
) -> tuple[float, float]:
    """Return how far outside the frame (across, down, px) any layer is read.

    A layer that is even outside the frame needs no margin.
    """
    reaches = [reach(spec) for spec in layer_specs(view) if extends_beyond_frame(spec, view)]
    across, down = zip((0.0, 0.0), *reaches, strict=True)
    return max(across), max(down)


def position_error(view: View) -> float:
    """Return how far positions in single precision may be off, px."""
    return float(np.spacing(np.float32(max(view.width, view.height))))


# Movement


def has_motion(view: View) -> bool:
    """Return whether the camera or a thing moves over the picture."""
    pan = view.camera[VELOCITY]
    return any(pan) or any(
        thing.spin or any(part.value for part in thing.velocity) for thing in view.scene.things
    )


def displacement(motion: Motion, view: View, time: float) -> tuple[float, float]:
    """Return the movement (px) of a layer over the sensor in a time (s), the camera's included."""
    own, all_ = motion.velocity, view.camera[VELOCITY]
    return (own[0] + all_[0]) * time, (own[1] + all_[1]) * time


def largest_chord(motion: Motion, view: View, time: float) -> float:
    """Return how far any point of a turning layer gets from its place within ``time`` s, px."""
    if not motion.spin:
        return 0.0
    turn, (x, y) = math.sin(min(abs(motion.spin) * time / 2.0, math.pi / 2.0)), motion.pivot
    # blur may have spread the layer as far as the farthest corner
    corner = math.hypot(max(x, view.width - 1 - x), max(y, view.height - 1 - y))
    return 2.0 * corner * turn + position_error(view)


def rotate_layer(layer: Layer, angles: Sequence[float | Field], reach: float) -> Layer:
    """Return the mean of a layer rotated by each of the angles about its pivot.

    Parameters
    ----------
    layer : Layer
    angles : sequence
        Of numbers, or arrays of shape (H, 1).
    reach : float
        Farthest that anything gets by these angles, px.
    """

    def turn(images: list[Image], box: PixelBox) -> list[Image]:
        """Return the rotated images of a box."""
        return _turn_images(images, box, layer.motion, angles)

    near = _turning_box(layer)
    return remake_layer(layer, sampling_reach(layer, (reach, reach)), turn, _TURNED, near)


def _turning_box(layer: Layer) -> PixelBox:
    """Return the box that a layer can reach by turning about its pivot."""
    shape = layer.colour.shape
    ends = content_box(layer)
    if any(not part.start or part.stop == side for part, side in zip(ends, shape, strict=False)):
        return full_box(shape)  # its edge is repeated outward, and comes in from there
    (x, y), corners = layer.motion.pivot, product(*((part.start, part.stop) for part in ends))
    far = max(math.hypot(row - y, column - x) for row, column in corners) + 1.0
    rows, columns = (
        slice(max(math.floor(middle - far), 0), min(math.ceil(middle + far) + 1, side))
        for middle, side in zip((y, x), shape, strict=False)
    )
    return rows, columns


_TURNED = 128, 1024
"""Rows and columns turned at once: few calls, and all that they need is small."""


def _turn_images(
    images: list[Image], box: PixelBox, motion: Motion, angles: Sequence[float | Field]
) -> list[Image]:
    """Return the mean of images over rotations by the angles, inside a box."""
    height, width = images[0].shape[:2]
    x = np.arange(width)[None, box[1]] - motion.pivot[0]
    y = np.arange(height)[box[0], None] - motion.pivot[1]
    totals = [np.zeros((y.size, x.size, image.shape[2]), image.dtype) for image in images]
    for angle in angles:
        by_row = angle if isinstance(angle, float) else angle[box[0]]
        cosine, sine = np.cos(by_row), np.sin(by_row)
        column = (cosine * x + sine * y + motion.pivot[0]).astype(images[0].dtype)
        row = (cosine * y - sine * x + motion.pivot[1]).astype(images[0].dtype)
        for place, image in enumerate(images):
            totals[place] += sample_bilinear(image, column, row)
    return [total * (1.0 / len(angles)) for total in totals]
