"""Outlines and textures of drawn things, as functions of the place along a thing's own axes, px."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.pixels.kernels import disc_area_below
from quizgen.camera.setup.scene import SceneObject

Coordinates = NDArray[np.float64]
Coverage = Coordinates | NDArray[np.bool_]
ShapeFunction = Callable[[SceneObject, Coordinates, Coordinates], Coordinates]
TextureFunction = Callable[[SceneObject, Coordinates, Coordinates], Coverage]


def _box_distance(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coordinates:
    """Return the signed distance to a box, largest of both axes, px."""
    return np.maximum(np.abs(x) - thing.width.value / 2, np.abs(y) - thing.height.value / 2)


def _disc_distance(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coordinates:
    """Return the signed distance to a disc, px.

    Below a radius of 1 px, the value that gives each pixel its exact share of the area: the soft
    edge would be wider than the disc.
    """
    radius = thing.radius.value
    if radius >= 1.0:
        return np.hypot(x, y) - radius
    left, right = (np.clip((x + side) / radius, -1.0, 1.0) for side in (-0.5, 0.5))
    upper, lower = (np.clip((y + side) / radius, -1.0, 1.0) for side in (-0.5, 0.5))
    corners = [
        disc_area_below(*np.broadcast_arrays(a, b)) for a in (left, right) for b in (upper, lower)
    ]
    return np.asarray(0.5 - radius**2 * (corners[3] - corners[2] - corners[1] + corners[0]))


def _ellipse_distance(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coordinates:
    """Return the signed distance to an ellipse, px, to first order near its outline."""
    half_width, half_height = thing.width.value / 2, thing.height.value / 2
    level = np.hypot(x / half_width, y / half_height)
    slope = np.hypot(x / half_width**2, y / half_height**2)
    middle = 1e-12  # where neither says anything
    return np.asarray((level - 1.0) * np.maximum(level, middle) / np.maximum(slope, middle))


def _grid_distance(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coordinates:
    """Return the signed distance to the nearest line of a grid, px."""

    def to_line(position: Coordinates) -> Coordinates:
        """Return the distance to the middle of the nearest line."""
        return np.abs(position - thing.cell.value * np.round(position / thing.cell.value))

    return np.minimum(to_line(x), to_line(y)) - thing.stroke.value / 2


def _blades_distance(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coordinates:
    """Return the signed distance to the blades of a propeller and its hub, px."""
    step = 2.0 * math.pi / thing.count
    turn = np.arctan2(y, x)
    turn -= step * np.round(turn / step)
    distance = np.hypot(x, y)
    along, aside = distance * np.cos(turn), distance * np.sin(turn)
    blade = np.maximum(np.abs(aside) - thing.stroke.value / 2, along - thing.radius.value)
    return np.asarray(np.minimum(blade, distance - thing.stroke.value * 0.8))


_NEAR = 1.0
"""Distance from the outline, px, beyond which only the side counts."""


def _polygon_distance(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coordinates:
    """Return the signed distance to a polygon, px; infinite beyond `_NEAR`, which saves time."""
    shape = np.broadcast_shapes(x.shape, y.shape)
    distance, inside = np.full(shape, np.inf), np.zeros(shape, bool)
    rows, columns = _value_ends(y, 1), _value_ends(x, 0)
    for (ax, ay), (bx, by) in zip(thing.points, (*thing.points[1:], thing.points[0]), strict=True):
        squared = (bx - ax) ** 2 + (by - ay) ** 2
        level = _find_near_lines(rows, ay, by)
        if not squared or level.start == level.stop:
            continue  # a corner given twice, such as the first one to close the outline, or far off
        here, there = (level, _find_near_lines(columns, ax, bx)), _select_lines(level, y)
        across, down = x[_select_lines(level, x)][:, here[1]] - ax, y[there] - ay
        if down.shape[1] > 1:
            down = down[:, here[1]]
        if across.size:
            along = np.clip((across * (bx - ax) + down * (by - ay)) / squared, 0.0, 1.0)
            away = np.hypot(across - along * (bx - ax), down - along * (by - ay))
            distance[here] = np.minimum(distance[here], away)
        if ay != by:
            crossing = (ay > y[there]) != (by > y[there])
            before = (bx - ax) * (y[there] - ay) / (by - ay) + ax
            inside[level] ^= crossing & (x[_select_lines(level, x)] < before)
    return np.where(inside, -distance, distance)


def _value_ends(plane: Coordinates, axis: int) -> tuple[Coordinates, Coordinates]:
    """Return the smallest and the largest value of every row or column."""
    return plane.min(axis=axis), plane.max(axis=axis)


def _find_near_lines(ends: tuple[Coordinates, Coordinates], start: float, stop: float) -> slice:
    """Return the rows or columns within `_NEAR` of a side from start to stop."""
    low, high = ends
    near = np.flatnonzero((high >= min(start, stop) - _NEAR) & (low <= max(start, stop) + _NEAR))
    return slice(near[0], near[-1] + 1) if near.size else slice(0, 0)


def _select_lines(rows: slice, plane: Coordinates) -> slice:
    """Return these rows of a plane, or the only one that stands for all."""
    return rows if len(plane) > 1 else slice(None)


def _everywhere(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coordinates:
    """Return -infinity: all of the picture is inside."""
    return np.full(np.broadcast_shapes(x.shape, y.shape), -np.inf)


SHAPES: dict[str, ShapeFunction] = {
    "box": _box_distance,
    "disc": _disc_distance,
    "ellipse": _ellipse_distance,
    "grid": _grid_distance,
    "blades": _blades_distance,
    "polygon": _polygon_distance,
    "full": _everywhere,
}
"""Signed distance to the outline in px, negative inside."""


SIZES = {
    "box": ("width", "height"),
    "disc": ("radius",),
    "ellipse": ("width", "height"),
    "grid": ("cell", "stroke"),
    "blades": ("radius", "stroke"),
    "polygon": ("points",),
    "full": (),
}
"""What each shape needs."""


def _checker_share(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coverage:
    """Return the share of the second colour in a checkerboard."""
    return _is_floor_odd(x / thing.cell.value) != _is_floor_odd(y / thing.cell.value)


def _is_floor_odd(place: Coordinates) -> NDArray[np.bool_]:
    """Return whether the integer part is odd; ``place`` is overwritten.

    NumPy's remainder takes three times as long.
    """
    half = np.floor(place, out=place)
    half *= 0.5
    return np.asarray(half != np.floor(half))


def _stripes_share(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coverage:
    """Return the share of the second colour in stripes with a cosine profile."""
    return _cosine_wave(2.0 * math.pi * x / thing.cell.value)


def _ramp_share(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coverage:
    """Return the share of the second colour, rising from 0 to 1 over the width."""
    return np.clip(x / max(thing.width.value, 1e-9) + 0.5, 0.0, 1.0)


def _rings_share(thing: SceneObject, x: Coordinates, y: Coordinates) -> Coverage:
    """Return the share of the second colour in rings (a zone plate).

    Their period shrinks to ``cell`` at ``radius``.
    """
    scale = math.pi / (thing.cell.value * max(thing.radius.value, 1.0))
    squared = x * x + y * y
    squared *= scale
    return _cosine_wave(squared)


def _cosine_wave(phase: Coordinates) -> Coverage:
    """Return (1 - cos phase)/2; ``phase`` is overwritten."""
    np.cos(phase, out=phase)
    phase *= 0.5
    return np.subtract(0.5, phase, out=phase)


TEXTURES: dict[str, TextureFunction | None] = {
    "plain": None,
    "checker": _checker_share,
    "stripes": _stripes_share,
    "ramp": _ramp_share,
    "rings": _rings_share,
}
"""Share of the second colour, in [0, 1]."""
