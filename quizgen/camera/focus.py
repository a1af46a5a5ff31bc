"""Layers out of focus: the disc of each depth, for all channels or for some of them.

The circles of confusion of a colour differ from those of green by the same amount at every depth,
its ``shift`` (see `quizgen.camera.effects.axial_colour`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from quizgen.camera.costs import convolution
from quizgen.camera.draw import Layer, Sheet, blend, content, sheets
from quizgen.camera.facts import Error, Facts, LayerFacts
from quizgen.camera.filters import convolve
from quizgen.camera.kernels import Kernel, change, disc
from quizgen.camera.layers import Field, blurred, farthest, wider, within
from quizgen.camera.scene import Image
from quizgen.camera.view import View

MAX_SLICES = 24


def defocused(layer: Layer, view: View, shift: float = 0.0, rung: str = "") -> Layer:
    """Blur a layer by its circle of confusion, depth by depth where it has a map."""
    if isinstance(layer.depth, np.ndarray):
        diameters = view.blur_diameter(layer.depth) + shift
        return replace(layer, colour=_blurred_by_depth(layer.colour, diameters, rung))
    return blurred(layer, disc(float(view.blur_diameter(layer.depth)) + shift))


def in_channels(layer: Layer, view: View, shifts: Mapping[int, float], rung: str) -> Layer:
    """Blur some channels of a layer, each by the discs of its own shift."""
    colour, cover = layer.colour.copy(), layer.cover
    if cover is not None:  # a cover for each colour
        cover = np.array(np.broadcast_to(cover, colour.shape))
    for channel, shift in shifts.items():
        own = slice(channel, channel + 1)
        seen = None if cover is None else np.ascontiguousarray(cover[..., own])
        part = replace(layer, colour=np.ascontiguousarray(colour[..., own]), cover=seen)
        blurry = defocused(part, view, shift, rung)
        colour[..., own] = blurry.colour
        if cover is not None and blurry.cover is not None:
            cover[..., own] = blurry.cover
    return replace(layer, colour=colour, cover=cover)


def slices(diameters: tuple[float, float], rung: str = "") -> Field:
    """Blur diameters of the slices of a depth map, px, ascending.

    Multiples of one step, so that what is in focus stays sharp: uniform in the signed circle of
    confusion (linear in 1/z). The step is 0.5 px, or more where that makes over `MAX_SLICES`.
    """
    least, most = diameters
    step = max(0.5, (most - least) / MAX_SLICES) * {"half": 2.0, "quarter": 4.0}.get(rung, 1.0)
    return step * np.arange(np.rint(least / step), np.rint(most / step) + 1.0)


def _blurred_by_depth(sharp: Image, diameters: NDArray[np.floating], rung: str) -> Image:
    """Lay blurred slices over each other, far ones first.

    The farthest slice is divided by its own blurred coverage, so that the colour of what stands in
    front does not leak into the background.
    """
    middles = slices((float(diameters.min()), float(diameters.max())), rung)
    step = middles[1] - middles[0] if len(middles) > 1 else math.inf
    index = np.clip(np.rint((diameters - middles[0]) / step), 0, len(middles) - 1).astype(np.uint8)
    picture = sharp
    for number in range(len(middles) - 1, -1, -1):
        there = (index == number)[..., None]
        if not there.any():
            continue
        kernel = disc(float(middles[number]))
        part = wider(content(there), kernel.shape[0] // 2, sharp.shape)
        mask = there[part].astype(sharp.dtype)
        colour, cover = convolve(sharp[part] * mask, kernel), convolve(mask, kernel)
        if picture is sharp:
            picture, seen = sharp.copy(), cover > 1e-3
            np.copyto(picture[part], colour / np.where(seen, cover, 1.0), where=seen)
        else:
            blend(picture[part], 1.0 - cover, colour)
    return picture


def outside(view: View, shifts: tuple[float, ...]) -> tuple[float, float]:
    """Discs bring light from as far as their radius."""

    def reach(sheet: Sheet) -> tuple[float, float]:
        circle = view.blur_diameter(math.inf if sheet.depth is None else sheet.depth)
        radius = max(abs(circle + shift) / 2.0 for shift in shifts)
        return radius + bool(radius), radius + bool(radius)

    return farthest(view, reach)


def disc_of(sheet: Sheet, view: View, shift: float = 0.0) -> Kernel:
    """Blur of a sheet at one depth."""
    return disc(view.blur_diameter(math.inf if sheet.depth is None else sheet.depth) + shift)


def by_depth(sheet: Sheet, view: View) -> bool:
    """Whether every pixel of a sheet has a depth of its own."""
    return sheet.opaque and view.has_depth_map


def map_slices(view: View, shift: float = 0.0, rung: str = "") -> Field:
    """Blur diameters of the slices of the scene's depth map, px."""
    diameters = view.blur_diameter(np.asarray(view.scene.depth))
    return slices((float(diameters.min()) + shift, float(diameters.max()) + shift), rung)


def map_error(layer: LayerFacts, view: View, shift: float = 0.0, rung: str = "") -> float:
    """Light comes from within the largest kernel; in a single slice taps pair up as usual."""
    middles = map_slices(view, shift, rung)
    largest = disc(float(np.abs(middles).max()))
    if len(middles) == 1:
        return change(largest, layer.jump, layer.bend, math.inf)
    reach = largest.shape[0] // 2
    return float(reach * (layer.jump[0] + layer.jump[1]))


def fewer_slices(facts: Facts, view: View, rung: str, shifts: tuple[float, ...]) -> Error:
    """Difference of a rung from the exact way: both average inside their largest kernel."""
    if not view.has_depth_map:
        return Error()
    first = facts.layers[0]
    apart = (map_error(first, view, s) + map_error(first, view, s, rung) for s in shifts)
    return within(max(apart), facts)


def after(facts: Facts, view: View, shifts: tuple[float, ...]) -> Facts:
    """A blur does not steepen a layer; the border between two slices may."""
    spread = facts.stepped(1.0, 1.0)
    if not view.has_depth_map:
        return spread
    first = facts.layers[0]
    worst = max(map_error(first, view, shift) for shift in shifts)
    step = min(facts.span, max(first.jump) + 2.0 * worst)
    base = LayerFacts((step, step), (2 * step, 2 * step))
    return replace(spread, layers=(base, *spread.layers[1:]))


def cost(view: View, rung: str, opencv_used: bool, shift: float = 0.0) -> float:
    """A convolution per layer and colour, or per slice of a depth map."""
    total = 0.0
    for sheet in sheets(view):
        if sheet.depth is None and sheet.opaque:
            kernels = [disc(float(c)) for c in map_slices(view, shift, rung)]
            total += sum(convolution(kernel, view, opencv_used) for kernel in kernels) * 1.5
        else:
            share = 1.0 if sheet.opaque else 4.0 / 3.0
            total += share * convolution(disc_of(sheet, view, shift), view, opencv_used)
    return total
