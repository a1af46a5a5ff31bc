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
from quizgen.camera.raster.detail_regions import grow_box
from quizgen.camera.raster.layers import Field, blur_layer, bound_layers, largest_margin
from quizgen.camera.raster.rasterizer import (
    Layer,
    LayerSpec,
    PixelBox,
    blend_into,
    bounding_box,
    layer_specs,
)
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.view import Signal, View

MAX_SLICES = 24


def blur_by_depth(layer: Layer, view: View, shift: float = 0.0) -> Layer:
    """Blur a layer by its circle of confusion, depth by depth where it has a map."""
    if isinstance(layer.depth, np.ndarray):
        middles = slice_diameters(_diameter_range(layer.depth, view, shift))
        index = _assign_slices(layer.depth, middles, view, shift)
        return replace(layer, colour=_blur_slices(layer.colour, index, middles))
    return blur_layer(layer, disc_kernel(float(view.blur_diameter(layer.depth)) + shift))


def blur_channels(layer: Layer, view: View, shifts: Mapping[int, float]) -> Layer:
    """Blur some channels of a layer, each by the discs of its own shift."""
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
    """Blur diameters of the slices of a depth map, px, ascending.

    Multiples of one step, so that what is in focus stays sharp: uniform in the signed circle of
    confusion (linear in 1/z). The step is 0.5 px, or more where that makes over `MAX_SLICES`.
    """
    least, most = diameters
    step = max(0.5, (most - least) / MAX_SLICES)
    return step * np.arange(np.rint(least / step), np.rint(most / step) + 1.0)


def _diameter_range(depth: Image, view: View, shift: float) -> tuple[float, float]:
    """Smallest and largest blur diameter of a depth map: farther is always more, or always less."""
    ends = view.blur_diameter(np.array([depth.min(), depth.max()], depth.dtype)) + shift
    return float(ends.min()), float(ends.max())


def _assign_slices(depth: Image, middles: Field, view: View, shift: float) -> NDArray[np.uint8]:
    """Number of the slice that each pixel of a depth map is in."""
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
    """Lay blurred slices over each other, far ones first.

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
    """Where light of a slice gets, and its blurred colour and coverage there, band by band."""
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
    """A picture where it is there, and as its last channel where that is."""
    channels = image.shape[2]
    found = np.empty((*image.shape[:2], channels + 1), image.dtype)
    for channel in range(channels):  # far faster than NumPy's loops over three values
        np.multiply(image[..., channel], there[..., 0], out=found[..., channel])
    found[..., channels] = there[..., 0]
    return found


def blur_margin(view: View, shifts: tuple[float, ...]) -> tuple[float, float]:
    """Discs bring light from as far as their radius."""

    def reach(spec: LayerSpec) -> tuple[float, float]:
        radius = max(abs(_spec_diameter(spec, view) + shift) / 2.0 for shift in shifts)
        return radius + bool(radius), radius + bool(radius)

    return largest_margin(view, reach)


def check_blur_width(view: View) -> None:
    """No disc may be too wide."""
    for spec in layer_specs(view):
        if not has_depth_map(spec, view):
            kernels.check_kernel_size(_spec_diameter(spec, view))


def _spec_diameter(spec: LayerSpec, view: View) -> float:
    return view.blur_diameter(math.inf if spec.depth is None else spec.depth)


def widest_disc(view: View) -> float:
    """Diameter of the largest disc that anything in the frame is blurred by, px."""
    widest = 0.0
    for spec in layer_specs(view):
        if has_depth_map(spec, view):
            ends = _diameter_range(np.asarray(view.scene.depth), view, 0.0)
            widest = max(widest, *(abs(end) for end in ends))
        else:
            widest = max(widest, abs(_spec_diameter(spec, view)))
    return widest


def has_depth_map(spec: LayerSpec, view: View) -> bool:
    """Whether every pixel of a layer has a depth of its own."""
    return spec.opaque and view.has_depth_map


def bound_discs(signal: Signal, view: View, shift: float | None = None) -> float:
    """How far a picture can be from one in which no layer is blurred, or all without a shift."""

    def share(spec: LayerSpec) -> float:
        if has_depth_map(spec, view):
            shifts = (0.0,) if shift is None else (0.0, shift)
            return sum(_moved_share_by_depth(view, one) for one in shifts)
        plain = disc_kernel(_spec_diameter(spec, view))
        if shift is None:
            return moved_share(plain)
        return moved_share(plain, disc_kernel(_spec_diameter(spec, view) + shift))

    return bound_layers(signal, view, share)


def _moved_share_by_depth(view: View, shift: float) -> float:
    """Share of the light that leaves its place where every pixel has a depth of its own.

    Slices are divided by their own blurred coverage, so that of several any may be all.
    """
    middles = slice_diameters(_diameter_range(np.asarray(view.scene.depth), view, shift))
    return moved_share(disc_kernel(float(middles[0]))) if len(middles) == 1 else 1.0
