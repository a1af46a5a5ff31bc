"""Effects of the lens and of motion: functions on the stack of layers, in linear light."""

# ruff: noqa: ARG001 - every effect and every bound takes the same arguments

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quizgen.camera.draw import Layer, Stack
from quizgen.camera.filters import convolve, sample, sample_grid, sample_nearest
from quizgen.camera.kernels import disc, line
from quizgen.camera.scene import Camera, Image, Length, Scene, SceneError, Thing, View

Field = NDArray[np.float64]

MAX_SLICES = 24
_NODES = 4096
_STEEPEST = 50.0


def projection(scene: Scene, view: View, rung: str = "") -> Scene:
    """Turn lengths in metres at a depth into pixels: x = f X/Z.

    Parameters
    ----------
    scene : Scene
        Things with lengths in m; a length in px stays.
    view : View
        Camera with focal length and pixel pitch.
    """
    return replace(scene, things=tuple(_project(thing, view.focal) for thing in scene.things))


def _project(thing: Thing, focal: float) -> Thing:
    def on_sensor(length: Length) -> Length:
        if not length.metric:
            return length
        if math.isinf(thing.depth):
            raise SceneError(f"a {thing.shape} in metres needs a finite depth")
        return Length(focal * length.value / thing.depth)

    lengths = {name: on_sensor(length) for name, length in thing.lengths().items()}
    velocity = on_sensor(thing.velocity[0]), on_sensor(thing.velocity[1])
    return replace(thing, velocity=velocity, **lengths)  # type: ignore[arg-type]


def _map_layer(layer: Layer, resample: Callable[[Image], Image]) -> Layer:
    cover = None if layer.cover is None else resample(layer.cover)
    return replace(layer, colour=resample(layer.colour), cover=cover)


# Radial distortion


def stretch(radius: Any, k1: float, k2: float) -> Any:
    """Factor L(r) = 1 + k1 r^2 + k2 r^4 from undistorted to distorted radius."""
    return 1.0 + radius**2 * (k1 + k2 * radius**2)


def slope(radius: Any, k1: float, k2: float) -> Any:
    """Derivative of r L(r); zero where the picture folds over."""
    return 1.0 + radius**2 * (3.0 * k1 + 5.0 * k2 * radius**2)


@lru_cache(maxsize=32)
def undistorted_radius(distorted: float, k1: float, k2: float) -> float:
    """Inverse of r L(r) on the branch that starts at 0 (bisection, then to the last bit).

    Raises
    ------
    SceneError
        If the radius lies at or beyond the fold, or so near that the picture is stretched more
        than 50 times there.
    """
    low, high = 0.0, _fold(k1, k2, distorted)
    if high * float(stretch(high, k1, k2)) < distorted:
        raise SceneError(
            f"the distortion k1={k1:g}, k2={k2:g} folds before the corner (radius {distorted:.4g})"
        )
    for _ in range(200):
        middle = (low + high) / 2
        if middle in (low, high):
            break
        low, high = (
            (low, middle) if middle * stretch(middle, k1, k2) > distorted else (middle, high)
        )
    return low


def _fold(k1: float, k2: float, distorted: float) -> float:
    """Largest radius up to which the slope stays above 1/50 (or surely far enough)."""
    least = 1.0 / _STEEPEST
    far = max(1.0, distorted) * _STEEPEST
    if k1 >= 0.0 and k2 >= 0.0:
        return far
    # slope - least is a quadratic in q = r^2: its smallest positive root
    roots = (
        np.roots([5.0 * k2, 3.0 * k1, 1.0 - least]) if k2 else np.array([-(1 - least) / (3 * k1)])
    )
    real = [root.real for root in np.atleast_1d(roots) if abs(root.imag) < 1e-12 and root.real > 0]
    return min([math.sqrt(root) for root in real] + [far])


@lru_cache(maxsize=4)
def _inverse_table(reach: float, k1: float, k2: float) -> tuple[Field, Field, float]:
    """Nodes of s = r_u/r_d over q = r_d^2, and ds/dq times the spacing."""
    top = undistorted_radius(reach, k1, k2)
    nodes = np.linspace(0.0, reach**2, _NODES)
    target = np.sqrt(nodes)
    radius = np.minimum(target * top / reach if reach else target, top)
    for _ in range(60):
        residual = radius * stretch(radius, k1, k2) - target
        radius = np.clip(radius - residual / slope(radius, k1, k2), 0.0, top)
    factor = stretch(radius, k1, k2)
    rate = -(k1 + 2.0 * k2 * radius**2) / (factor**3 * slope(radius, k1, k2))
    spacing = nodes[1]
    return 1.0 / factor, rate * spacing, 1.0 / spacing


def _hermite(q: Field, table: tuple[Field, Field, float]) -> Field:
    """Cubic through values and slopes of the table: exact to about 1e-13."""
    values, rates, scale = table
    position = q * scale
    cell = np.minimum(position.astype(np.intp), _NODES - 2)
    t = position - cell
    first, second = values[cell], values[cell + 1]
    bend = rates[cell] - (second - first)
    other = (second - first) - rates[cell + 1]
    return np.asarray(first + t * ((second - first) + (1 - t) * (bend * (1 - t) + other * t)))


def _axes(view: View) -> tuple[Field, Field]:
    x, y = view.centre
    return np.arange(view.width, dtype=np.float64) - x, np.arange(view.height, dtype=np.float64) - y


@lru_cache(maxsize=2)
def _source(width: int, height: int, focal: float, k1: float, k2: float) -> tuple[Image, Image]:
    """Where each output pixel comes from; one quadrant is computed, the rest mirrored."""
    across, down = np.arange(width) - (width - 1) / 2, np.arange(height) - (height - 1) / 2
    right, lower = np.abs(across[: (width + 1) // 2]), np.abs(down[: (height + 1) // 2])
    squared = (right[None, :] ** 2 + lower[:, None] ** 2) / focal**2
    reach = math.hypot(right[0], lower[0]) / focal
    factor = _hermite(squared, _inverse_table(reach, k1, k2))
    factor = np.concatenate([factor, factor[:, width // 2 - 1 :: -1]], axis=1)
    factor = np.concatenate([factor, factor[height // 2 - 1 :: -1]], axis=0)
    x, y = factor * across + (width - 1) / 2, factor * down[:, None] + (height - 1) / 2
    return x.astype(np.float32), y.astype(np.float32)


def distortion(stack: Stack, view: View, rung: str = "") -> Stack:
    """Radial distortion about the principal point.

    Parameters
    ----------
    stack : tuple of Layer
    view : View
        Camera with k1 and k2 (radius in focal lengths).
    rung : str
        ``nearest`` takes the nearest pixel instead of interpolating.
    """
    camera = view.camera
    x, y = _source(view.width, view.height, view.focal, camera.k1, camera.k2)
    pick = sample_nearest if rung == "nearest" else sample
    warped = (_map_layer(layer, lambda image: pick(image, x, y)) for layer in stack)
    return tuple(_with_depth(layer, x, y) for layer in warped)


def _with_depth(layer: Layer, x: Image, y: Image) -> Layer:
    if not isinstance(layer.depth, np.ndarray):
        return layer
    return replace(layer, depth=sample_nearest(layer.depth, x, y))


def lateral_colour(stack: Stack, view: View, rung: str = "") -> Stack:
    """Red magnified and blue reduced, by ``lateral_colour`` px at the corner; green stays."""
    return tuple(_split_colours(layer, view) for layer in stack)


def colour_scales(camera: Camera, corner: float) -> tuple[float, float, float]:
    """Magnification of red, green, blue."""
    share = camera.lateral_colour / corner
    return 1.0 + share, 1.0, 1.0 - share


def _split_colours(layer: Layer, view: View) -> Layer:
    def resample(image: Image) -> Image:
        return np.stack([_scaled(image, view, channel) for channel in range(3)], axis=2)

    return _map_layer(layer, resample)


def _scaled(image: Image, view: View, channel: int) -> Image:
    scale = colour_scales(view.camera, view.corner)[channel]
    plane = image[..., min(channel, image.shape[2] - 1)]
    if scale == 1.0:
        return plane
    across, down = _axes(view)
    return sample_grid(plane, across / scale + view.centre[0], down / scale + view.centre[1])


# Defocus


def defocus(stack: Stack, view: View, rung: str = "") -> Stack:
    """Blur every layer by the disc of its own circle of confusion.

    Coverage is blurred with the colour, so that a sharp layer in front keeps its edge and a
    blurred one in front lets the background shine through.

    Parameters
    ----------
    stack : tuple of Layer
    view : View
    rung : str
        ``half`` and ``quarter`` use fewer slices of a depth map.
    """
    return tuple(part for layer in stack for part in _blurred(layer, view, rung))


def _blurred(layer: Layer, view: View, rung: str) -> Stack:
    if isinstance(layer.depth, np.ndarray):
        return (replace(layer, colour=_blurred_by_depth(layer, view, rung), depth=math.inf),)
    kernel = disc(float(view.blur_diameter(layer.depth)))
    return (_map_layer(layer, lambda image: convolve(image, kernel)),)


def slices(diameters: tuple[float, float], rung: str = "") -> Field:
    """Blur diameters of the slices of a depth map, px, ascending.

    Multiples of one step, so that what is in focus stays sharp: uniform in the signed circle of
    confusion (linear in 1/z). The step is 0.5 px, or more where that makes over `MAX_SLICES`.
    """
    least, most = diameters
    step = max(0.5, (most - least) / MAX_SLICES) * {"half": 2.0, "quarter": 4.0}.get(rung, 1.0)
    return step * np.arange(np.rint(least / step), np.rint(most / step) + 1.0)


def _blurred_by_depth(layer: Layer, view: View, rung: str) -> Image:
    """Lay blurred slices over each other, far ones first.

    The farthest slice is divided by its own blurred coverage, so that the colour of what stands in
    front does not leak into the background.
    """
    diameters = np.asarray(view.blur_diameter(layer.depth))
    middles = slices((float(diameters.min()), float(diameters.max())), rung)
    step = middles[1] - middles[0] if len(middles) > 1 else math.inf
    index = np.clip(np.rint((diameters - middles[0]) / step).astype(int), 0, len(middles) - 1)
    picture = layer.colour
    for number in range(len(middles) - 1, -1, -1):
        mask = (index == number)[..., None].astype(np.float32)
        if not mask.any():
            continue
        kernel = disc(float(middles[number]))
        colour, cover = convolve(layer.colour * mask, kernel), convolve(mask, kernel)
        if picture is layer.colour:
            seen = cover > np.float32(1e-3)
            picture = np.where(seen, colour / np.where(seen, cover, np.float32(1.0)), picture)
        else:
            picture = colour + (np.float32(1.0) - cover) * picture
    return picture


# Motion


def path(layer: Layer, view: View, time: float) -> tuple[float, float]:
    """Movement of a layer over the sensor in a time, px, the camera's own included."""
    own, all_ = layer.motion.velocity, view.camera.velocity
    return (own[0] + all_[0]) * time, (own[1] + all_[1]) * time


def turns(spin: float, reach: float, shutter: float) -> int:
    """Samples of a rotating layer: at most 1 px apart at its rim, 64 at most."""
    return min(64, max(1, math.ceil(abs(spin) * shutter * reach)))


def motion_blur(stack: Stack, view: View, rung: str = "") -> Stack:
    """Average over the exposure: a box along straight paths, sampled positions for rotation.

    Parameters
    ----------
    stack : tuple of Layer
    view : View
    rung : str
        ``half`` takes every second rotated position.
    """
    return tuple(_smeared(layer, view, rung) for layer in stack)


def _smeared(layer: Layer, view: View, rung: str) -> Layer:
    kernel = line(*path(layer, view, view.camera.shutter))
    moved = _map_layer(layer, lambda image: convolve(image, kernel))
    if not layer.motion.spin:
        return moved
    count = turns(layer.motion.spin, layer.motion.reach, view.camera.shutter)
    count = max(1, count // 2) if rung == "half" else count
    angles = ((np.arange(count) + 0.5) / count - 0.5) * layer.motion.spin * view.camera.shutter
    return _map_layer(moved, lambda image: _mean_turned(image, view, layer, angles))


def _mean_turned(image: Image, view: View, layer: Layer, angles: Field) -> Image:
    total = np.zeros_like(image)
    for angle in angles:
        total += _turned(image, view, layer, float(angle))
    return total * np.float32(1.0 / len(angles))


def _turned(image: Image, view: View, layer: Layer, angle: float | Field) -> Image:
    """Rotate a layer about its pivot; an angle per row for the rolling shutter."""
    x = np.arange(view.width)[None, :] - layer.motion.pivot[0]
    y = np.arange(view.height)[:, None] - layer.motion.pivot[1]
    cosine, sine = np.cos(angle), np.sin(angle)
    column = cosine * x + sine * y + layer.motion.pivot[0]
    row = cosine * y - sine * x + layer.motion.pivot[1]
    return sample(image, column.astype(np.float32), row.astype(np.float32))


def row_times(view: View) -> Field:
    """When each row is read, s, the middle row at 0."""
    rows: Field = np.arange(view.height, dtype=np.float64) - (view.height - 1) / 2
    return rows * view.camera.row_time


def rolling_shutter(stack: Stack, view: View, rung: str = "") -> Stack:
    """Read each row at its own time: what moves is sheared, what turns is bent."""
    return tuple(_rolled(layer, view) for layer in stack)


def _rolled(still: Layer, view: View) -> Layer:
    times = row_times(view)[:, None]
    across, down = path(still, view, 1.0)
    layer = still
    if still.motion.spin:
        angle = still.motion.spin * times
        layer = _map_layer(still, lambda image: _turned(image, view, still, angle))
    if not across and not down:
        return layer
    x = np.arange(view.width)[None, :] - across * times
    y = np.arange(view.height)[:, None] - down * times + np.zeros_like(x)
    where = x.astype(np.float32), y.astype(np.float32)
    return _map_layer(layer, lambda image: sample(image, *where))
