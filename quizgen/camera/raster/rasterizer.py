"""Draw a scene as a stack of layers, farthest first, with one-pixel soft edges.

Layers are kept apart only where something needs it: different blur or different motion.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby

import msgspec
import numpy as np

from quizgen.camera.pixels.tiles import split_range
from quizgen.camera.raster.shapes import SHAPES, TEXTURES, Coordinates
from quizgen.camera.setup.scene import Image, SceneError, SceneObject
from quizgen.camera.setup.settings import aperture_diameter
from quizgen.camera.setup.view import View


class Motion(msgspec.Struct, frozen=True):
    """How a layer moves: velocity (px/s), spin (rad/s) about a pivot (px), outline's reach."""

    velocity: tuple[float, float] = (0.0, 0.0)
    spin: float = 0.0
    pivot: tuple[float, float] = (0.0, 0.0)
    reach: float = 0.0

    @property
    def is_still(self) -> bool:
        """Whether nothing moves."""
        return self.velocity == (0.0, 0.0) and self.spin == 0.0


STILL = Motion()


ALL_CHANNELS = (0, 1, 2)


class Layer(msgspec.Struct, frozen=True):
    """One layer of the picture: everything that shares a depth and a motion.

    Parameters
    ----------
    colour : numpy.ndarray
        Shape (H, W, 3), linear radiance times coverage.
    cover : numpy.ndarray or None
        Shape (H, W, 1) or (H, W, 3), coverage in [0, 1]; None is opaque everywhere.
    depth : float or numpy.ndarray
        m; a map of shape (H, W) for a picture with depth.
    motion : Motion
    sharp : tuple of int
        Channels that are not out of focus yet: axial colour takes red and blue before the rest.
    own : bool
        Whether nobody else needs its memory, so that it may be written over.
    """

    colour: Image
    cover: Image | None = None
    depth: float | Image = math.inf
    motion: Motion = STILL
    sharp: tuple[int, ...] = ALL_CHANNELS
    own: bool = False

    @property
    def is_uniform(self) -> bool:
        """Whether the layer has a single colour and covers everything."""
        if self.cover is not None or not (self.colour[0] == self.colour[0, 0]).all():
            return False
        bands = range(0, len(self.colour), _ROWS)
        return all((self.colour[at : at + _ROWS] == self.colour[0]).all() for at in bands)


_ROWS = 64
"""Rows looked at at once."""

LayerStack = tuple[Layer, ...]
PixelBox = tuple[slice, slice]
"""Rows and columns."""


def composite_layers(stack: LayerStack) -> Image:
    """Return the layers laid over each other, farthest first; one opaque layer is not copied."""
    if len(stack) == 1:
        return stack[0].colour
    picture = stack[0].colour.copy()
    for layer in stack[1:]:
        picture = composite_over(layer, picture)
    return picture


def composite_over(layer: Layer, picture: Image) -> Image:
    """Return a layer over a picture, which is overwritten."""
    cover = layer.cover
    if cover is None:
        return layer.colour
    rows, columns = bounding_box(cover)
    height = max(1, _BAND // max(1, columns.stop - columns.start))
    for start in range(rows.start, rows.stop, height):
        part = slice(start, min(start + height, rows.stop)), columns
        blend_into(picture[part], 1.0 - cover[part], layer.colour[part])
    return picture


def blend_into(behind: Image, keep: Image, image: Image) -> None:
    """Multiply ``behind`` by the share that is kept, for all or each channel, and add an image."""
    if keep.shape == behind.shape:
        behind *= keep
    else:
        for channel in range(behind.shape[2]):  # far faster than NumPy's loops over three values
            plane = behind[..., channel]
            plane *= keep[..., 0]
    behind += image


def bounding_box(cover: Image) -> PixelBox:
    """Return the smallest box around what a coverage does not leave empty."""
    rows = np.flatnonzero(cover.reshape(len(cover), -1).any(axis=1))
    if not rows.size:
        return slice(0, 0), slice(0, 0)
    columns = np.flatnonzero(np.any(cover[rows[0] : rows[-1] + 1], axis=0).any(axis=1))
    return slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)


def full_box(shape: tuple[int, ...]) -> PixelBox:
    """Return the box of all rows and columns."""
    return slice(0, shape[0]), slice(0, shape[1])


def grow_box(box: PixelBox, far: tuple[int, int], shape: tuple[int, ...]) -> PixelBox:
    """Return a box with more rows and columns on each side, within the picture.

    An empty box stays empty.
    """
    if not box[0].stop:
        return box
    rows, columns = (
        slice(max(part.start - more, 0), min(part.stop + more, length))
        for part, more, length in zip(box, far, shape, strict=False)
    )
    return rows, columns


def _centre_of(thing: SceneObject, view: View) -> tuple[float, float]:
    """Return the centre of a thing on the picture (x, y), px from the first pixel."""
    return view.centre[0] + thing.x.value, view.centre[1] + thing.y.value


_BAND = 1 << 16
"""Pixels laid over each other at once, about, so that what lies in between stays small."""


def _extent(thing: SceneObject) -> tuple[float, float]:
    """Return how far a thing reaches from its centre, across and down, px, soft edge included."""
    if thing.shape == "box" and not thing.angle:
        return thing.width.value / 2 + 1.0, thing.height.value / 2 + 1.0
    if thing.shape == "disc":  # which may have been given the sides of a box, too
        return thing.radius.value + 1.0, thing.radius.value + 1.0
    if thing.shape in ("grid", "full") or (thing.shape == "blades" and thing.count == 1):
        return math.inf, math.inf
    far = outline_radius(thing) + thing.stroke.value
    if thing.shape == "ellipse":  # the edge of a thin one is softer along its length
        far *= 1.0 + 1.0 / min(thing.width.value, thing.height.value)
    return far, far


def extends_beyond_frame(spec: LayerSpec, view: View) -> bool:
    """Return whether anything but an even surface lies outside the frame."""
    right, lower = (view.scene.width - 1) / 2.0, (view.scene.height - 1) / 2.0
    for thing in spec.things:
        across, down = _extent(thing)
        beyond = abs(thing.x.value) + across > right or abs(thing.y.value) + down > lower
        if beyond and not (thing.shape == "full" and thing.texture == "plain"):
            return True
    return False


def _thing_box(thing: SceneObject, view: View) -> PixelBox:
    """Return the box of the picture that a thing can cover."""

    def part(middle: float, far: float, length: int) -> slice:
        """Return the rows or columns within ``far`` of the middle."""
        if math.isinf(far):
            return slice(0, length)
        ends = math.floor(middle - far), math.ceil(middle + far) + 1
        return slice(*(min(max(end, 0), length) for end in ends))

    (column, row), (across, down) = _centre_of(thing, view), _extent(thing)
    return part(row, down, view.height), part(column, across, view.width)


def intersect_boxes(one: PixelBox, other: PixelBox) -> PixelBox | None:
    """Return the common part of two boxes; None if there is none."""
    rows, columns = (
        slice(max(a.start, b.start), min(a.stop, b.stop)) for a, b in zip(one, other, strict=True)
    )
    return (rows, columns) if rows.start < rows.stop and columns.start < columns.stop else None


def _to_own_axes(
    thing: SceneObject, view: View, rows: Coordinates, columns: Coordinates
) -> tuple[Coordinates, Coordinates]:
    """Return pixel positions along a thing's own axes, from its centre, px.

    A row and a column, or two planes if the thing is turned.
    """
    column, row = _centre_of(thing, view)
    x, y = columns[None, :] - column, rows[:, None] - row
    if not thing.angle:
        return x, y
    cosine, sine = math.cos(thing.angle), math.sin(thing.angle)
    return cosine * x + sine * y, cosine * y - sine * x


def _pixel_centres(part: slice) -> Coordinates:
    """Return the positions of a slice of pixels as numbers."""
    return np.arange(part.start, part.stop, dtype=np.float64)


def _draw_thing(layer: Layer, thing: SceneObject, view: View, part: PixelBox) -> None:
    """Draw what is seen of a thing in a box, with its soft edge.

    Where it covers nothing, nothing is written: memory that is not written to takes none.
    """
    place = _to_own_axes(thing, view, *map(_pixel_centres, part))
    share = np.subtract(0.5, SHAPES[thing.shape](thing, *place))
    np.maximum(share, 0.0, out=share)
    np.minimum(share, 1.0, out=share)
    cover = share.astype(view.precision)
    if not cover.any():
        return
    image = np.empty((*cover.shape, 3), view.precision)
    for channel, plane in enumerate(_colour_planes(thing, view, place)):
        np.multiply(cover, plane, out=image[..., channel])  # far faster than all three together
    keep = 1.0 - cover[..., None]
    blend_into(layer.colour[part], keep, image)
    if layer.cover is not None:
        blend_into(layer.cover[part], keep, cover[..., None])


def _colour_planes(
    thing: SceneObject, view: View, place: tuple[Coordinates, Coordinates]
) -> Sequence[float | Image]:
    """Return a thing's red, green and blue over a box, each a number or a plane."""
    texture = TEXTURES[thing.texture]
    if texture is None:
        return thing.colour
    share = texture(thing, *place).astype(view.precision)
    rest, pairs = 1.0 - share, zip(thing.colour, thing.other, strict=True)
    return [rest * one + share * two for one, two in pairs]


def outline_radius(thing: SceneObject) -> float:
    """Return the largest distance of a thing's outline from its own centre, px."""
    corners = [math.hypot(*point) for point in thing.points]
    box = math.hypot(thing.width.value, thing.height.value) / 2.0
    return max(thing.radius.value, box, *corners, 0.0) + 1.0


def thing_motion(thing: SceneObject, view: View) -> Motion:
    """Return how a thing moves over the picture."""
    across, down = thing.velocity[0].value, thing.velocity[1].value
    if not thing.spin:
        return Motion((across, down)) if across or down else STILL
    return Motion((across, down), thing.spin, _centre_of(thing, view), outline_radius(thing))


class LayerSpec(msgspec.Struct, frozen=True):
    """A layer before it is drawn: its depth (m, None for a map), motion and things."""

    depth: float | None
    motion: Motion
    things: tuple[SceneObject, ...]
    opaque: bool


def layer_specs(view: View) -> tuple[LayerSpec, ...]:
    """Return the layers that a scene needs, farthest first.

    Things of one blur and motion share one.
    """
    scene = view.scene
    behind = scene.background_depth if scene.image is None else scene.depth
    base = None if isinstance(behind, np.ndarray) else behind
    bare = LayerSpec(base, STILL, (), opaque=True)
    if not scene.things:
        return (bare,)
    found = [bare]
    ordered = sorted(scene.things, key=lambda thing: -thing.depth)
    focused = aperture_diameter(view.camera) is not None

    def key(thing: SceneObject) -> tuple[float | None, Motion]:
        """Return what the things of one layer have in common."""
        return (thing.depth if focused else None), thing_motion(thing, view)

    for (depth, moves), group in groupby(ordered, key=key):
        things = tuple(group)
        if found == [bare] and moves.is_still and depth in (base, None):
            found[0] = LayerSpec(base, STILL, things, opaque=True)
        elif scene.image is None and any(thing.shape == "full" for thing in things):
            found = [LayerSpec(depth, moves, things, opaque=True)]  # nothing behind it is seen
        else:
            found.append(LayerSpec(depth, moves, things, opaque=False))
    return tuple(found)


def rasterize(view: View) -> LayerStack:
    """Return the drawn layers of a scene.

    Parameters
    ----------
    view : View
        All lengths in px (see `quizgen.camera.effects.projection`).

    Returns
    -------
    tuple of Layer
        Farthest first; the first is opaque. A bare picture is returned untouched.
    """
    if view.scene.is_metric:
        raise SceneError("lengths in metres must be projected first")
    return tuple(_draw_layer(spec, view) for spec in layer_specs(view))


def _draw_layer(spec: LayerSpec, view: View) -> Layer:
    """Return the drawn layer of a specification, one band of rows after the other."""
    layer, boxes = _allocate_layer(spec, view), [_thing_box(thing, view) for thing in spec.things]
    if view.scene.image is not None and not spec.things:
        return layer
    line = np.empty((view.width, 3), view.precision)
    line[...] = view.scene.background
    for start, stop in split_range(view.height, max(1, _BAND // view.width)):
        rows = slice(start, stop)
        if spec.opaque and view.scene.image is None:
            layer.colour[rows] = line
        for thing, box in zip(spec.things, boxes, strict=True):
            part = intersect_boxes((rows, slice(0, view.width)), box)
            if part is not None:
                _draw_thing(layer, thing, view, part)
    return layer


def _allocate_layer(spec: LayerSpec, view: View) -> Layer:
    """Return a layer with nothing drawn yet, or the scene's own picture."""
    scene, shape = view.scene, (view.height, view.width)
    depth = math.inf if spec.depth is None else spec.depth
    if not spec.opaque:
        colour, cover = (np.zeros((*shape, channels), view.precision) for channels in (3, 1))
        return Layer(colour, cover, depth, spec.motion)
    if scene.image is not None:
        image = scene.image.astype(view.precision, copy=bool(spec.things))
        return Layer(image, depth=scene.depth)
    return Layer(np.empty((*shape, 3), view.precision), depth=depth, motion=spec.motion)
