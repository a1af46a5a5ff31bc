"""Layers out of focus: the disc of each depth, for all channels or for some of them.

The circles of confusion of a colour differ from those of green by the same amount at every depth,
its ``shift`` (see `quizgen.camera.effects.axial_colour`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from quizgen.camera.pixels import kernels
from quizgen.camera.pixels.filters import convolve
from quizgen.camera.pixels.kernels import BlurKernel, disc_kernel, moved_share
from quizgen.camera.pixels.tiles import split_range
from quizgen.camera.raster.layers import Field, blur_layer, bound_layers, largest_margin
from quizgen.camera.raster.rasterizer import (
    Layer,
    LayerSpec,
    PixelBox,
    blend_into,
    bounding_box,
    grow_box,
    layer_specs,
)
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.view import Signal, View

MAX_SLICES = 24


def blur_by_depth(layer: Layer, view: View, shift: float = 0.0) -> Layer:
    """Return a layer blurred by its circle of confusion, slice by slice if it has a depth map.

    ``shift`` (px) is added to every diameter.
    """
    if isinstance(layer.depth, np.ndarray):
        middles = slice_diameters(_diameter_range(layer.depth, view, shift))
        index = _assign_slices(layer.depth, middles, view, shift)
        return replace(layer, colour=_blur_slices(layer.colour, index, middles))
    return blur_layer(layer, disc_kernel(float(view.blur_diameter(layer.depth)) + shift))


def blur_channels(layer: Layer, view: View, shifts: Mapping[int, float]) -> Layer:
    """Return a layer with some channels blurred, each by discs with its own shift of diameter."""
    colour, cover = layer.colour.copy(), layer.cover
    if cover is not None:  # a cover for each colour
        cover = np.array(np.broadcast_to(cover, colour.shape))
    for channel, shift in shifts.items():
        own = slice(channel, channel + 1)
        seen = None if cover is None else np.ascontiguousarray(cover[..., own])
        light = np.ascontiguousarray(colour[..., own])
        part = replace(layer, colour=light, cover=seen, own=False)
        blurry = blur_by_depth(part, view, shift)
        colour[..., own] = blurry.colour
        if cover is not None and blurry.cover is not None:
            cover[..., own] = blurry.cover
    return replace(layer, colour=colour, cover=cover, own=True)


def slice_diameters(diameters: tuple[float, float]) -> Field:
    """Return the blur diameters (px, ascending) of the slices that a depth map is cut into.

    Multiples of one step, so that what is in focus stays sharp: uniform in the signed circle of
    confusion (linear in 1/z). The step is 0.5 px, or more where that makes over `MAX_SLICES`.
    """
    least, most = diameters
    step = max(0.5, (most - least) / MAX_SLICES)
    return step * np.arange(np.rint(least / step), np.rint(most / step) + 1.0)


def _diameter_range(depth: Image, view: View, shift: float) -> tuple[float, float]:
    """Return the smallest and the largest blur diameter of a depth map, px."""
    ends = view.blur_diameter(np.array([depth.min(), depth.max()], depth.dtype)) + shift
    return float(ends.min()), float(ends.max())


def _assign_slices(depth: Image, middles: Field, view: View, shift: float) -> NDArray[np.uint8]:
    """Return for each pixel of a depth map the number of the slice that it is in."""
    step = float(middles[1] - middles[0]) if len(middles) > 1 else math.inf
    index = np.empty(depth.shape, np.uint8)
    for start, stop in split_range(len(depth), _ROWS):
        apart = view.blur_diameter(depth[start:stop]) + shift - float(middles[0])
        index[start:stop] = np.clip(np.rint(apart / step), 0, len(middles) - 1)
    return index


_ROWS = 64
"""Rows looked at at once."""
_BAND = 128
"""Rows blurred at once; eight times as many as light gets far, where that is more."""


def _blur_slices(sharp: Image, index: NDArray[np.uint8], middles: Field) -> Image:
    """Return the picture with each slice blurred by its own disc, laid over each other far to near.

    The farthest slice is divided by its own blurred coverage, so that the colour of what stands in
    front does not leak into the background.
    """
    picture, farthest = sharp.copy(), int(index.max())
    for number in range(farthest, -1, -1):
        for part, blurry in _iter_slice_bands(
            sharp, index, number, disc_kernel(float(middles[number]))
        ):
            colour, cover = blurry[..., :-1], blurry[..., -1:]
            if number == farthest:
                seen = cover > 1e-3
                np.copyto(picture[part], colour / np.where(seen, cover, 1.0), where=seen)
            else:
                blend_into(picture[part], 1.0 - cover, colour)
    return picture


def _iter_slice_bands(
    sharp: Image, index: NDArray[np.uint8], number: int, kernel: BlurKernel
) -> Iterator[tuple[PixelBox, Image]]:
    """Yield boxes that the light of a slice reaches, each with its blurred colour and coverage.

    ``index`` has the slice of every pixel; ``number`` is the slice that ``kernel`` blurs.
    """
    reach = kernel.shape[0] // 2
    for start, stop in split_range(len(sharp), max(_BAND, 8 * reach)):
        first = max(start - reach, 0)
        there = (index[first : stop + reach] == number)[..., None]
        rows, columns = grow_box(bounding_box(there), (reach, reach), there.shape)
        top, bottom = max(first + rows.start, start), min(first + rows.stop, stop)
        if top >= bottom:
            continue
        blurry = convolve(_append_mask(sharp[first:][rows, columns], there[rows, columns]), kernel)
        yield (slice(top, bottom), columns), blurry[top - first - rows.start :][: bottom - top]


def _append_mask(image: Image, there: NDArray[np.bool_]) -> Image:
    """Return a picture that is empty where ``there`` is false, with that mask as last channel."""
    channels = image.shape[2]
    found = np.empty((*image.shape[:2], channels + 1), image.dtype)
    for channel in range(channels):  # far faster than NumPy's loops over three values
        np.multiply(image[..., channel], there[..., 0], out=found[..., channel])
    found[..., channels] = there[..., 0]
    return found


def blur_margin(view: View, shifts: tuple[float, ...]) -> tuple[float, float]:
    """Return how far outside the frame discs bring light from, across and down, px."""

    def reach(spec: LayerSpec) -> tuple[float, float]:
        """Return the largest radius of a layer's discs, px."""
        radius = max(abs(_spec_diameter(spec, view) + shift) / 2.0 for shift in shifts)
        return radius + bool(radius), radius + bool(radius)

    return largest_margin(view, reach)


def check_blur_width(view: View) -> None:
    """Raise an error if a disc is too wide to be computed."""
    for spec in layer_specs(view):
        if not has_depth_map(spec, view):
            kernels.check_kernel_size(_spec_diameter(spec, view))


def _spec_diameter(spec: LayerSpec, view: View) -> float:
    """Return the largest blur diameter of a layer, px, without sign."""
    return view.blur_diameter(math.inf if spec.depth is None else spec.depth)


def widest_disc(view: View) -> float:
    """Return the diameter, px, of the largest disc that blurs anything in the frame."""
    widest = 0.0
    for spec in layer_specs(view):
        if has_depth_map(spec, view):
            ends = _diameter_range(np.asarray(view.scene.depth), view, 0.0)
            widest = max(widest, *(abs(end) for end in ends))
        else:
            widest = max(widest, abs(_spec_diameter(spec, view)))
    return widest


def has_depth_map(spec: LayerSpec, view: View) -> bool:
    """Return whether every pixel of a layer has a depth of its own."""
    return spec.opaque and view.has_depth_map


def bound_discs(signal: Signal, view: View, shift: float | None = None) -> float:
    """Return how far a picture can be from one in which no layer is blurred.

    With a shift: from one in which all discs are ``shift`` px wider.
    """

    def share(spec: LayerSpec) -> float:
        """Return how much of its range a layer can change."""
        if has_depth_map(spec, view):
            shifts = (0.0,) if shift is None else (0.0, shift)
            return sum(_moved_share_by_depth(view, one) for one in shifts)
        plain = disc_kernel(_spec_diameter(spec, view))
        if shift is None:
            return moved_share(plain)
        return moved_share(plain, disc_kernel(_spec_diameter(spec, view) + shift))

    return bound_layers(signal, view, share)


def _moved_share_by_depth(view: View, shift: float) -> float:
    """Return the share of light that leaves its pixel in a picture with a depth map.

    Slices are divided by their own blurred coverage, so that of several any may be all.
    """
    middles = slice_diameters(_diameter_range(np.asarray(view.scene.depth), view, shift))
    return moved_share(disc_kernel(float(middles[0]))) if len(middles) == 1 else 1.0
