"""Defocus: every layer blurred by the disc of its own circle of confusion."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from quizgen.camera.body import aperture
from quizgen.camera.costs import at_least_a_call, convolution
from quizgen.camera.draw import Layer, Sheet, sheets
from quizgen.camera.effect import Effect, LayerByLayer, Rung
from quizgen.camera.facts import Error, Facts, LayerFacts
from quizgen.camera.filters import convolve
from quizgen.camera.kernels import change, disc
from quizgen.camera.layers import Field, blurred, each, within
from quizgen.camera.scene import Image
from quizgen.camera.view import View

MAX_SLICES = 24


def work(layer: Layer, view: View, rung: str = "") -> Layer:
    """Blur a layer by the disc of its own circle of confusion.

    Coverage is blurred with the colour, so that a sharp layer in front keeps its edge and a
    blurred one in front lets the background shine through. The rungs ``half`` and ``quarter`` use
    fewer slices of a depth map.
    """
    if isinstance(layer.depth, np.ndarray):
        colour = _blurred_by_depth(layer.colour, layer.depth, view, rung)
        return replace(layer, colour=colour, depth=math.inf)
    return blurred(layer, disc(float(view.blur_diameter(layer.depth))))


def slices(diameters: tuple[float, float], rung: str = "") -> Field:
    """Blur diameters of the slices of a depth map, px, ascending.

    Multiples of one step, so that what is in focus stays sharp: uniform in the signed circle of
    confusion (linear in 1/z). The step is 0.5 px, or more where that makes over `MAX_SLICES`.
    """
    least, most = diameters
    step = max(0.5, (most - least) / MAX_SLICES) * {"half": 2.0, "quarter": 4.0}.get(rung, 1.0)
    return step * np.arange(np.rint(least / step), np.rint(most / step) + 1.0)


def _blurred_by_depth(sharp: Image, depth: Image, view: View, rung: str) -> Image:
    """Lay blurred slices over each other, far ones first.

    The farthest slice is divided by its own blurred coverage, so that the colour of what stands in
    front does not leak into the background.
    """
    diameters = view.blur_diameter(depth)
    middles = slices((float(diameters.min()), float(diameters.max())), rung)
    step = middles[1] - middles[0] if len(middles) > 1 else math.inf
    index = np.clip(np.rint((diameters - middles[0]) / step).astype(int), 0, len(middles) - 1)
    picture = sharp
    for number in range(len(middles) - 1, -1, -1):
        mask = (index == number)[..., None].astype(np.float32)
        if not mask.any():
            continue
        kernel = disc(float(middles[number]))
        colour, cover = convolve(sharp * mask, kernel), convolve(mask, kernel)
        if picture is sharp:
            seen = cover > np.float32(1e-3)
            picture = np.where(seen, colour / np.where(seen, cover, np.float32(1.0)), picture)
        else:
            picture = colour + (np.float32(1.0) - cover) * picture
    return picture


def _blur_of(sheet: Sheet, view: View) -> float:
    """Signed circle of confusion of a sheet at one depth, px."""
    return view.blur_diameter(math.inf if sheet.depth is None else sheet.depth)


def _map_range(view: View) -> tuple[float, float]:
    """Smallest and largest signed circle of confusion of a depth map, px."""
    diameters = view.blur_diameter(np.asarray(view.scene.depth))
    return float(diameters.min()), float(diameters.max())


def _map_error(layer: LayerFacts, view: View, rung: str = "") -> float:
    """Light comes from within the largest kernel; in a single slice taps pair up as usual."""
    middles = slices(_map_range(view), rung)
    largest = disc(float(np.abs(middles).max()))
    if len(middles) == 1:
        return change(largest, layer.jump, layer.bend, math.inf)
    reach = largest.shape[0] // 2
    return float(reach * (layer.jump[0] + layer.jump[1]))


def skipped(facts: Facts, view: View) -> Error:
    """Sum over layers of what each layer's disc can change."""
    total = 0.0
    for layer, sheet, most in each(facts, view):
        if sheet.opaque and view.has_depth_map:
            total += _map_error(layer, view)
        else:
            total += change(disc(_blur_of(sheet, view)), layer.jump, layer.bend, most)
    return within(total, facts)


def _fewer_slices(rung: str) -> Rung:
    def error(facts: Facts, view: View) -> Error:
        """Both ways average inside their largest kernel."""
        if not view.has_depth_map:
            return Error()
        exact, rough = (_map_error(facts.layers[0], view, way) for way in ("", rung))
        return within(exact + rough, facts)

    return Rung(rung, error)


def after(facts: Facts, view: View) -> Facts:
    """A blur does not steepen a layer; the border between two slices may."""
    spread = facts.stepped(1.0, 1.0)
    if not view.has_depth_map:
        return spread
    first = facts.layers[0]
    step = min(facts.span, max(first.jump) + 2.0 * _map_error(first, view))
    base = LayerFacts((step, step), (2 * step, 2 * step))
    return replace(spread, layers=(base, *spread.layers[1:]))


def cost(view: View, rung: str, opencv_used: bool) -> float:
    """A convolution per layer and colour, or per slice of a depth map."""
    total = 0.0
    for sheet in sheets(view):
        if sheet.depth is None and sheet.opaque:
            kernels = [disc(float(c)) for c in slices(_map_range(view), rung)]
            total += sum(convolution(kernel, view, opencv_used) for kernel in kernels) * 1.5
        else:
            share = 1.0 if sheet.opaque else 4.0 / 3.0
            total += share * convolution(disc(_blur_of(sheet, view)), view, opencv_used)
    return total


EFFECT = Effect(
    name="defocus",
    stage="optics",
    decides=("defocus", "depth of field", "aperture", "artefacts"),
    present=lambda view: aperture(view.camera) is not None,
    run=LayerByLayer(work),
    cost=at_least_a_call(cost),
    skipped=skipped,
    after=after,
    rungs=(_fewer_slices("half"), _fewer_slices("quarter")),
)
