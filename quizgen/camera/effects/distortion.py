"""Radial distortion about the principal point, undistorted to distorted, in focal lengths."""

from __future__ import annotations

import math
import sys
from functools import lru_cache
from typing import TypeVar

import numpy as np
from msgspec.structs import replace

from quizgen.camera.effect import Effect, EffectSize, LayerByLayer
from quizgen.camera.pixels.filters import sample_bilinear, sample_nearest
from quizgen.camera.pixels.tiles import split_range
from quizgen.camera.raster.layers import (
    Field,
    bound_shift,
    largest_margin,
    remake_layer,
    sampling_reach,
)
from quizgen.camera.raster.rasterizer import Layer, PixelBox
from quizgen.camera.setup.scene import Image, SceneError
from quizgen.camera.setup.settings import NEEDS_LENS, Setting, aperture_diameter
from quizgen.camera.setup.value_parsers import parse_plain_number
from quizgen.camera.setup.view import Signal, View
from quizgen.numerics.distortion import fold_radius, inverse_radius

K1 = Setting("k1", parse_plain_number, 0.0, (NEEDS_LENS,))
"""k1 < 0 is barrel."""
K2 = Setting("k2", parse_plain_number, 0.0, (NEEDS_LENS,))

_NODES = 4096
_LEAST_SLOPE = 1.0 / 50.0


Radius = TypeVar("Radius", float, Field)


def radial_factor(radius: Radius, k1: float, k2: float) -> Radius:
    """Return L(r) = 1 + k1 r^2 + k2 r^4, distorted over undistorted radius (in focal lengths)."""
    return 1.0 + radius**2 * (k1 + k2 * radius**2)


def radial_slope(radius: Radius, k1: float, k2: float) -> Radius:
    """Return the derivative of r L(r); zero where the picture folds over."""
    return 1.0 + radius**2 * (3.0 * k1 + 5.0 * k2 * radius**2)


def _largest_distorted_radius(k1: float, k2: float) -> float:
    """Return the distorted radius, in focal lengths, up to which the picture may be computed.

    Beyond it the picture is stretched more than 50 times.
    """
    # the slope reaches s where 1 + 3 k1/(1-s) r^2 + 5 k2/(1-s) r^4 vanishes
    rest = 1.0 - _LEAST_SLOPE
    steep = float(fold_radius(k1 / rest, k2 / rest))
    return steep * (1.0 + steep**2 * (k1 + k2 * steep**2))


@lru_cache(maxsize=32)
def undistorted_radius(distorted: float, k1: float, k2: float) -> float:
    """Return the undistorted radius of a distorted one, both in focal lengths, below the fold.

    Raises
    ------
    SceneError
        If the radius lies at or beyond the fold, or so near that the picture is stretched more
        than 50 times there.
    """
    if _largest_distorted_radius(k1, k2) < distorted:
        shares = (digit * 10.0**power for power in range(-1, -40, -1) for digit in range(9, 0, -1))
        fits = (
            share
            for share in shares
            if _largest_distorted_radius(share * k1, share * k2) >= distorted
        )
        weaker = next(fits, 0.0)  # of one digit
        raise SceneError(
            f"the distortion k1={k1:g}, k2={k2:g} folds before the corner of the picture; "
            f"k1={weaker * k1:.3g}, k2={weaker * k2:.3g} does not"
        )
    return float(inverse_radius(distorted, k1, k2))


@lru_cache(maxsize=4)
def _build_inverse_table(reach: float, k1: float, k2: float) -> tuple[Field, Field, float]:
    """Return a table of s = r_u/r_d over q = r_d^2: values, slopes times spacing, 1/spacing."""
    undistorted_radius(reach, k1, k2)
    nodes = np.linspace(0.0, reach**2, _NODES)
    radius = np.asarray(inverse_radius(np.sqrt(nodes), k1, k2))
    factor = radial_factor(radius, k1, k2)
    rate = -(k1 + 2.0 * k2 * radius**2) / (factor**3 * radial_slope(radius, k1, k2))
    spacing = nodes[1]
    return 1.0 / factor, rate * spacing, 1.0 / spacing


def _interpolate_hermite(q: Field, table: tuple[Field, Field, float]) -> Field:
    """Return s at q from the table, by cubics through values and slopes.

    Within 1e-13, or 1e-5 where a picture is stretched most.
    """
    values, rates, scale = table
    position = q * scale
    cell = np.minimum(position.astype(np.intp), _NODES - 2)
    t = position - cell
    first, second = values[cell], values[cell + 1]
    bend = rates[cell] - (second - first)
    other = (second - first) - rates[cell + 1]
    return np.asarray(first + t * ((second - first) + (1 - t) * (bend * (1 - t) + other * t)))


def source_positions(view: View, box: PixelBox = (slice(None), slice(None))) -> tuple[Image, Image]:
    """Return x and y (px) from which the pixels of a box are read, shape of the box each.

    Beyond the corner of the frame, where the picture may fold, undistorted over distorted radius
    stays what it is there.
    """
    focal, corner = view.focal, view.frame_corner
    table = _build_inverse_table(corner / focal, view.camera[K1], view.camera[K2])
    (x0, y0), kind = view.centre, view.precision
    across = (np.arange(view.width) - x0)[box[1]]
    down = (np.arange(view.height) - y0)[box[0], None]
    squared = across**2 + down**2
    factor = _interpolate_hermite(np.minimum(squared, corner**2) / focal**2, table)
    return (factor * across + x0).astype(kind), (factor * down + y0).astype(kind)


_BAND = 64
"""Rows that are read at once, so that what lies in between stays small."""


def operation(layer: Layer, view: View) -> Layer:
    """Return a layer in which every pixel is read from its source position."""

    def warp(images: list[Image], box: PixelBox) -> list[Image]:
        """Return colour and cover of a box, sampled at the source positions."""
        x, y = source_positions(view, box)
        return [sample_bilinear(image, x, y) for image in images]

    far = largest_displacement(view)
    reach = sampling_reach(layer, (far, far))
    layer = remake_layer(layer, reach, warp, (_BAND, sys.maxsize))
    if not isinstance(layer.depth, np.ndarray):
        return layer
    depth = np.empty_like(layer.depth)
    for start, stop in split_range(len(depth), _BAND):
        depth[start:stop] = sample_nearest(
            layer.depth, *source_positions(view, (slice(start, stop), slice(None)))
        )
    return replace(layer, depth=depth)


def _corner_radius(view: View) -> float:
    """Return the undistorted radius of the frame's corner; raise if the picture folds before it."""
    return undistorted_radius(view.frame_corner / view.focal, view.camera[K1], view.camera[K2])


def largest_displacement(view: View) -> float:
    """Return a bound on how far distortion moves any point, px: |k1| r^3 + |k2| r^5.

    In a margin beyond the corner it grows as the radius does.
    """
    k1, k2, top = view.camera[K1], view.camera[K2], _corner_radius(view)
    distance = view.focal * top**3 * (abs(k1) + abs(k2) * top**2)
    return distance * (view.corner / view.frame_corner if any(view.margin) else 1.0)


def margin(view: View) -> tuple[float, float]:
    """Return how far outside the frame barrel distortion reads, across and down, px."""
    k1, k2 = view.camera[K1], view.camera[K2]
    beside = max(
        0.0, 1.0 / min(radial_factor(radius, k1, k2) for radius in _find_turning_radii(view)) - 1.0
    )
    x, y = view.centre
    return largest_margin(view, lambda _: (x * beside, y * beside))


def _find_turning_radii(view: View) -> list[float]:
    """Return the radii between which the factor and its slope are monotonic."""
    k1, k2, top = view.camera[K1], view.camera[K2], _corner_radius(view)
    turning = [-k1 / (2 * k2), -3 * k1 / (10 * k2)] if k2 else []
    return [0.0, top, *(math.sqrt(q) for q in turning if 0 < q < top * top)]


def omission_bound(signal: Signal, view: View) -> float:
    """Return the bound for the largest displacement; the whole range if a depth map moves, too."""
    distance = largest_displacement(view)
    if aperture_diameter(view.camera) is not None and view.has_depth_map and distance >= 0.5:
        return signal.span
    return bound_shift(signal, view, distance)


EFFECT = Effect(
    name="distortion",
    answers=("distortion", "geometry", "artefacts"),
    settings=(K1, K2),
    is_present=lambda view: view.camera[K1] != 0.0 or view.camera[K2] != 0.0,
    margin=margin,
    check_camera=_corner_radius,
    run=LayerByLayer(operation),
    omission_bound=omission_bound,
    size=EffectSize(largest_displacement, "move points by up to {:.3g} px", 1.0),
)
