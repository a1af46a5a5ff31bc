"""How much the effects of lens and motion can matter, from facts alone.

A stack shows an error of its layers as at most the sum over layers of the colour's error plus half
the range times the cover's; `LayerFacts` hold steps weighted in exactly that way.
"""

# ruff: noqa: ARG001 - every effect and every bound takes the same arguments

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from quizgen.camera.draw import Motion, Sheet, sheets
from quizgen.camera.effects.optics import slices, slope, stretch, turns, undistorted_radius
from quizgen.camera.facts import Error, Facts, LayerFacts
from quizgen.camera.kernels import Kernel, change, disc, line
from quizgen.camera.scene import View


def _layers(facts: Facts, view: View) -> Iterator[tuple[LayerFacts, Sheet, float]]:
    """Facts and sheet of every layer, and the most that a layer's error can show."""
    for layer, sheet in zip(facts.layers, sheets(view), strict=True):
        yield layer, sheet, facts.span * (1.0 if sheet.opaque else 1.5)


def _within(amount: float, facts: Facts) -> Error:
    """Every picture made by averaging stays inside the range."""
    return Error(min(amount, facts.span))


def shifted(facts: Facts, distance: float) -> Error:
    """Error of reading every layer a distance away, px: distance times the steepest slope."""
    return _within(sum(distance * math.hypot(*layer.jump) for layer in facts.layers), facts)


# Distortion and lateral colour


def _top_radius(view: View) -> float:
    camera = view.camera
    return undistorted_radius(view.corner / view.focal, camera.k1, camera.k2)


def largest_displacement(view: View) -> float:
    """Bound on how far distortion moves any point of the picture, px: |k1| r^3 + |k2| r^5."""
    radius = _top_radius(view)
    return float(view.focal * radius**3) * (abs(view.camera.k1) + abs(view.camera.k2) * radius**2)


def _magnification(view: View) -> float:
    """Largest distance on the source per pixel of output (extremes of two quadratics in r^2)."""
    k1, k2, top = view.camera.k1, view.camera.k2, _top_radius(view)
    turning = [-k1 / (2 * k2), -3 * k1 / (10 * k2)] if k2 else []
    radii = [0.0, top] + [math.sqrt(q) for q in turning if 0 < q < top * top]
    least = [min(float(slope(r, k1, k2)), float(stretch(r, k1, k2))) for r in radii]
    return 1.0 / min(least)


def distortion_skipped(facts: Facts, view: View) -> Error:
    """Largest displacement times the steepest slope; anything where a depth map moves along."""
    distance = largest_displacement(view)
    if view.camera.f_number is not None and _has_map(view) and distance >= 0.5:
        return Error(facts.span)
    return shifted(facts, distance)


def _has_map(view: View) -> bool:
    return isinstance(view.scene.depth, np.ndarray)


def distortion_nearest(facts: Facts, view: View) -> Error:
    """At most half a pixel along each axis."""
    return _within(sum(sum(layer.jump) for layer in facts.layers) / 2.0, facts)


def distortion_after(facts: Facts, view: View) -> Facts:
    """Steps grow by the local magnification."""
    return _turned_steps(facts, _magnification(view))


def _turned_steps(facts: Facts, factor: float) -> Facts:
    layers = []
    for layer in facts.layers:
        step = factor * math.hypot(*layer.jump)
        layers.append(LayerFacts((step, step), (2 * step, 2 * step)))
    return replace(facts, layers=tuple(layers))


def _lateral_share(view: View) -> float:
    return abs(view.camera.lateral_colour) / view.corner


def lateral_skipped(facts: Facts, view: View) -> Error:
    """Shift at the corner times the steepest slope."""
    return shifted(facts, abs(view.camera.lateral_colour) / (1.0 - _lateral_share(view)))


def lateral_after(facts: Facts, view: View) -> Facts:
    """Steps grow by the reduced colour's scale."""
    factor = 1.0 / (1.0 - _lateral_share(view))
    return facts.stepped(factor, factor)


# Defocus


def blur_of(sheet: Sheet, view: View) -> float:
    """Signed circle of confusion of a sheet at one depth, px."""
    return float(view.blur_diameter(math.inf if sheet.depth is None else sheet.depth))


def map_range(view: View) -> tuple[float, float]:
    """Smallest and largest signed circle of confusion of a depth map, px."""
    diameters = np.asarray(view.blur_diameter(np.asarray(view.scene.depth)))
    return float(diameters.min()), float(diameters.max())


def _map_error(layer: LayerFacts, view: View, rung: str = "") -> float:
    """Light comes from within the largest kernel; in a single slice taps pair up as usual."""
    middles = slices(map_range(view), rung)
    largest = disc(float(np.abs(middles).max()))
    if len(middles) == 1:
        return change(largest, layer.jump, layer.bend, math.inf)
    reach = largest.shape[0] // 2
    return float(reach * (layer.jump[0] + layer.jump[1]))


def defocus_skipped(facts: Facts, view: View) -> Error:
    """Sum over layers of what each layer's disc can change."""
    total = 0.0
    for layer, sheet, most in _layers(facts, view):
        if sheet.opaque and _has_map(view):
            total += _map_error(layer, view)
        else:
            total += change(disc(blur_of(sheet, view)), layer.jump, layer.bend, most)
    return _within(total, facts)


def _fewer_slices(facts: Facts, view: View, rung: str) -> Error:
    if not _has_map(view):
        return Error()
    exact, rough = (_map_error(facts.layers[0], view, way) for way in ("", rung))
    return _within(exact + rough, facts)


def defocus_half(facts: Facts, view: View) -> Error:
    """Both ways average inside their largest kernel."""
    return _fewer_slices(facts, view, "half")


def defocus_quarter(facts: Facts, view: View) -> Error:
    """As `defocus_half`."""
    return _fewer_slices(facts, view, "quarter")


def defocus_after(facts: Facts, view: View) -> Facts:
    """A blur does not steepen a layer; the border between two slices may."""
    spread = facts.stepped(1.0, 1.0)
    if not _has_map(view):
        return spread
    first = facts.layers[0]
    step = min(facts.span, max(first.jump) + 2.0 * _map_error(first, view))
    base = LayerFacts((step, step), (2 * step, 2 * step))
    return replace(spread, layers=(base, *spread.layers[1:]))


# Motion


def _rim(motion: Motion, view: View) -> float:
    """Distance from the pivot to the farthest corner, px: blur may have spread a layer so far."""
    x, y = motion.pivot
    return math.hypot(max(x, view.width - 1 - x), max(y, view.height - 1 - y))


def _chord(motion: Motion, view: View, time: float) -> float:
    """Farthest any point of a turning layer gets from where it is at time 0, px."""
    return 2.0 * _rim(motion, view) * math.sin(min(abs(motion.spin) * time / 2.0, math.pi / 2.0))


def _path(sheet: Sheet, view: View, time: float) -> tuple[float, float]:
    own, all_ = sheet.motion.velocity, view.camera.velocity
    return (own[0] + all_[0]) * time, (own[1] + all_[1]) * time


def _streak(sheet: Sheet, view: View) -> Kernel:
    return line(*_path(sheet, view, view.camera.shutter))


def motion_skipped(facts: Facts, view: View) -> Error:
    """What the box along the path can change, and the chord for rotation."""
    total = 0.0
    for layer, sheet, most in _layers(facts, view):
        total += change(_streak(sheet, view), layer.jump, layer.bend, most)
        total += _chord(sheet.motion, view, view.camera.shutter / 2) * math.hypot(*layer.jump)
    return _within(total, facts)


def motion_half(facts: Facts, view: View) -> Error:
    """Both sets of positions lie within half a sample of the continuous path."""
    total = 0.0
    for layer, sheet, _ in _layers(facts, view):
        moves, shutter = sheet.motion, view.camera.shutter
        count = turns(moves.spin, moves.reach, shutter)
        apart = 0.5 / count + 0.5 / max(1, count // 2)
        total += apart * abs(moves.spin) * shutter * _rim(moves, view) * math.hypot(*layer.jump)
    return _within(total, facts)


def motion_after(facts: Facts, view: View) -> Facts:
    """Averages do not steepen; rotation mixes the axes."""
    turning = any(sheet.motion.spin for sheet in sheets(view))
    return _turned_steps(facts, 1.0) if turning else facts.stepped(1.0, 1.0)


def _half_readout(view: View) -> float:
    return (view.height - 1) / 2 * view.camera.row_time


def rolling_skipped(facts: Facts, view: View) -> Error:
    """How far things move until the first or last row is read, times the steepest slope."""
    time, total = _half_readout(view), 0.0
    for layer, sheet, _ in _layers(facts, view):
        across, down = _path(sheet, view, time)
        total += abs(across) * layer.jump[0] + abs(down) * layer.jump[1]
        total += _chord(sheet.motion, view, time) * math.hypot(*layer.jump)
    return _within(total, facts)


def rolling_after(facts: Facts, view: View) -> Facts:
    """A shear: one row down also means a row time's movement."""
    layers = []
    for layer, sheet, _ in _layers(facts, view):
        across, down = (abs(part) for part in _path(sheet, view, view.camera.row_time))
        turn = abs(sheet.motion.spin) * view.camera.row_time * _rim(sheet.motion, view)
        x, y = layer.jump if not turn else (math.hypot(*layer.jump) * (1 + turn),) * 2
        step = x, y * (1 + down) + x * across
        layers.append(LayerFacts(step, (2 * step[0], 2 * step[1])))
    return replace(facts, layers=tuple(layers))
