"""Draw a scene as a stack of layers, farthest first, with one-pixel soft edges.

Layers are kept apart only where something needs it: different blur or different motion.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby, starmap

import msgspec
import numpy as np

from quizgen.camera.blocks import pieces
from quizgen.camera.raster.cells import ALL, CELL, States, band, runs, states
from quizgen.camera.raster.outlines import CLOSEST, SHAPES, TEXTURES, Plane
from quizgen.camera.scene import Image, SceneError, Thing
from quizgen.camera.setup.body import aperture
from quizgen.camera.view import View
from quizgen.numerics.ufunc import warm_allocator


class Motion(msgspec.Struct, frozen=True):
    """How a layer moves: px/s, rad/s about a pivot (px from the first pixel), and its reach."""

    velocity: tuple[float, float] = (0.0, 0.0)
    spin: float = 0.0
    pivot: tuple[float, float] = (0.0, 0.0)
    reach: float = 0.0

    @property
    def still(self) -> bool:
        """Whether nothing moves."""
        return self.velocity == (0.0, 0.0) and self.spin == 0.0


STILL = Motion()


ALL_CHANNELS = (0, 1, 2)


class Layer(msgspec.Struct, frozen=True):
    """One depth of the picture.

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
    def even(self) -> bool:
        """Whether it has a single colour and covers everything."""
        if self.cover is not None or not (self.colour[0] == self.colour[0, 0]).all():
            return False
        bands = range(0, len(self.colour), _ROWS)
        return all((self.colour[at : at + _ROWS] == self.colour[0]).all() for at in bands)


_ROWS = 64
"""Rows looked at at once."""

Stack = tuple[Layer, ...]
Box = tuple[slice, slice]
"""Rows and columns."""


def composite(stack: Stack) -> Image:
    """Lay the layers over each other, farthest first; one opaque layer is returned as it is."""
    if len(stack) == 1:
        return stack[0].colour
    picture = stack[0].colour.copy()
    for layer in stack[1:]:
        picture = lay_over(layer, picture)
    return picture


def lay_over(layer: Layer, picture: Image) -> Image:
    """Lay a layer over a picture that nobody else needs."""
    cover = layer.cover
    if cover is None:
        return layer.colour
    rows, columns = content(cover)
    height = max(1, _BAND // max(1, columns.stop - columns.start))
    for start in range(rows.start, rows.stop, height):
        part = slice(start, min(start + height, rows.stop)), columns
        blend(picture[part], 1.0 - cover[part], layer.colour[part])
    return picture


def blend(behind: Image, keep: Image, image: Image) -> None:
    """Keep a share of what is behind, one for all channels or one for each, and add an image."""
    if keep.shape == behind.shape:
        behind *= keep
    else:
        for channel in range(behind.shape[2]):  # far faster than NumPy's loops over three values
            plane = behind[..., channel]
            plane *= keep[..., 0]
    behind += image


def content(cover: Image) -> Box:
    """Where a cover is not empty: the smallest box, none at all if there is nothing."""
    rows = np.flatnonzero(cover.reshape(len(cover), -1).any(axis=1))
    if not rows.size:
        return slice(0, 0), slice(0, 0)
    columns = np.flatnonzero(np.any(cover[rows[0] : rows[-1] + 1], axis=0).any(axis=1))
    return slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)


def _place(thing: Thing, view: View) -> tuple[float, float]:
    return view.centre[0] + thing.x.value, view.centre[1] + thing.y.value


_BAND = 1 << 16
"""Pixels laid over each other at once, about, so that what lies in between stays small."""


def _extent(thing: Thing) -> tuple[float, float]:
    """Across and down from a thing's centre, where it covers nothing, soft edge included, px."""
    if thing.shape == "box" and not thing.angle:
        return thing.width.value / 2 + 1.0, thing.height.value / 2 + 1.0
    if thing.shape == "disc":  # which may have been given the sides of a box besides
        return thing.radius.value + 1.0, thing.radius.value + 1.0
    if thing.shape in ("grid", "full") or (thing.shape == "blades" and thing.count == 1):
        return math.inf, math.inf
    far = reach(thing) + thing.stroke.value
    if thing.shape == "ellipse":  # the edge of a thin one is softer along its length
        far *= 1.0 + 1.0 / min(thing.width.value, thing.height.value)
    return far, far


def leaves_frame(sheet: Sheet, view: View) -> bool:
    """Whether anything but an even surface stands outside the frame."""
    middle = (view.scene.width - 1) / 2.0, (view.scene.height - 1) / 2.0
    return any(_leaves(thing, middle) for thing in sheet.things)


def _leaves(thing: Thing, middle: tuple[float, float]) -> bool:
    if thing.shape == "full" and thing.texture == "plain":
        return False
    (across, down), (x, y) = _extent(thing), (abs(thing.x.value), abs(thing.y.value))
    return x + across > middle[0] or y + down > middle[1]


def _within(middle: float, far: float, length: int) -> tuple[int, int]:
    """First and last (exclusive) pixel of a line that may lie so far from a place."""
    if math.isinf(far):
        return 0, length
    return (
        min(max(math.floor(middle - far), 0), length),
        min(max(math.ceil(middle + far) + 1, 0), length),
    )


def _box(thing: Thing, view: View) -> Box:
    """The part of the picture that a thing can cover."""
    (column, row), (across, down) = _place(thing, view), _extent(thing)
    rows, columns = _within(row, down, view.height), _within(column, across, view.width)
    return slice(*rows), slice(*columns)


def both(one: Box, other: Box) -> Box | None:
    """What two boxes share."""
    rows, columns = (
        slice(max(a.start, b.start), min(a.stop, b.stop)) for a, b in zip(one, other, strict=True)
    )
    return (rows, columns) if rows.start < rows.stop and columns.start < columns.stop else None


def _own_axes(thing: Thing, view: View, rows: Plane, columns: Plane) -> tuple[Plane, Plane]:
    """Places from a thing's centre along its own axes: a row and a column, or planes if turned."""
    column, row = _place(thing, view)
    x, y = columns[None, :] - column, rows[:, None] - row
    if not thing.angle:
        return x, y
    cosine, sine = math.cos(thing.angle), math.sin(thing.angle)
    return cosine * x + sine * y, cosine * y - sine * x


def _pixels(part: slice) -> Plane:
    return np.arange(part.start, part.stop, dtype=np.float64)


def _add(layer: Layer, thing: Thing, view: View, part: Box, *, empty: bool) -> bool:
    """Draw the edge upon a part of a layer, empty or not; say whether anything is there to draw.

    Memory nothing is written to is not taken from the system.
    """
    place = _own_axes(thing, view, *map(_pixels, part))
    share = np.subtract(0.5, SHAPES[thing.shape](thing, *place))
    np.maximum(share, 0.0, out=share)
    np.minimum(share, 1.0, out=share)
    cover = share.astype(view.precision)
    if not cover.any():
        return False
    image = np.empty((*cover.shape, 3), view.precision)
    for channel, plane in enumerate(_planes(thing, view, place)):
        np.multiply(cover, plane, out=image[..., channel])  # far faster than all three together
    if empty:  # nothing behind is kept
        _lay(layer, part, image, cover[..., None])
        return True
    keep = 1.0 - cover[..., None]
    blend(layer.colour[part], keep, image)
    if layer.cover is not None:
        blend(layer.cover[part], keep, cover[..., None])
    return True


def _lay(layer: Layer, part: Box, image: Image, cover: Image | float) -> None:
    layer.colour[part] = image
    if layer.cover is not None:
        layer.cover[part] = cover


def _fill(layer: Layer, thing: Thing, view: View, part: Box) -> None:
    """Draw upon a part of a layer that a thing covers; of an even one a row stands for all."""
    rows, columns = map(_pixels, part)
    planes = _planes(thing, view, _own_axes(thing, view, rows, columns))
    shape = np.broadcast_shapes((1, columns.size), *map(np.shape, planes))
    image = np.empty((*shape, 3), view.precision)
    for channel, plane in enumerate(planes):
        image[..., channel] = plane
    _lay(layer, part, image, 1.0)


def _planes(thing: Thing, view: View, place: tuple[Plane, Plane]) -> Sequence[float | Image]:
    """A thing's colours over a part."""
    texture = TEXTURES[thing.texture]
    if texture is None:
        return thing.colour
    share = texture(thing, *place).astype(view.precision)
    rest, pairs = 1.0 - share, zip(thing.colour, thing.other, strict=True)
    return [rest * one + share * two for one, two in pairs]


def reach(thing: Thing) -> float:
    """Largest distance of a thing's outline from its own centre, px."""
    corners = [math.hypot(*point) for point in thing.points]
    box = math.hypot(thing.width.value, thing.height.value) / 2.0
    return max(thing.radius.value, box, *corners, 0.0) + 1.0


def motion(thing: Thing, view: View) -> Motion:
    """How a thing moves over the picture."""
    across, down = thing.velocity[0].value, thing.velocity[1].value
    if not thing.spin:
        return Motion((across, down)) if across or down else STILL
    return Motion((across, down), thing.spin, _place(thing, view), reach(thing))


class Sheet(msgspec.Struct, frozen=True):
    """A layer before it is drawn: its depth (None for a depth map), motion and things."""

    depth: float | None
    motion: Motion
    things: tuple[Thing, ...]
    opaque: bool


def sheets(view: View) -> tuple[Sheet, ...]:
    """Which layers a scene needs, farthest first: things that share blur and motion share one."""
    scene = view.scene
    behind = scene.background_depth if scene.image is None else scene.depth
    base = None if isinstance(behind, np.ndarray) else behind
    bare = Sheet(base, STILL, (), opaque=True)
    if not scene.things:
        return (bare,)
    found = [bare]
    ordered = sorted(scene.things, key=lambda thing: -thing.depth)
    focused = aperture(view.camera) is not None

    def key(thing: Thing) -> tuple[float | None, Motion]:
        return (thing.depth if focused else None), motion(thing, view)

    for (depth, moves), group in groupby(ordered, key=key):
        things = tuple(group)
        if found == [bare] and moves.still and depth in (base, None):
            found[0] = Sheet(base, STILL, things, opaque=True)
        elif scene.image is None and any(thing.shape == "full" for thing in things):
            found = [Sheet(depth, moves, things, opaque=True)]  # nothing behind it is seen
        else:
            found.append(Sheet(depth, moves, things, opaque=False))
    return tuple(found)


_SETTLED = 30 << 20
"""Bytes, just below the most that the C library takes note of (32 MiB)."""


def draw(view: View) -> Stack:
    """Draw everything.

    Parameters
    ----------
    view : View
        All lengths in px (see `quizgen.camera.effects.projection`).

    Returns
    -------
    tuple of Layer
        Farthest first; the first is opaque. A bare picture is returned untouched.
    """
    if view.scene.metric:
        raise SceneError("lengths in metres must be projected first")
    warm_allocator(_SETTLED)
    return tuple(_draw_sheet(sheet, view) for sheet in sheets(view))


def _draw_sheet(sheet: Sheet, view: View) -> Layer:
    """One band after the other, each with all that it shows."""
    layer, boxes = _bare(sheet, view), [_box(thing, view) for thing in sheet.things]
    if view.scene.image is not None and not sheet.things:
        return layer
    line = np.empty((view.width, 3), view.precision)
    line[...] = view.scene.background
    each = [_states(thing, view) for thing in sheet.things]
    for number, rows in enumerate(starmap(slice, pieces(view.height, band(view.width)))):
        hidden = bool(each) and (each[0][number] == ALL).all()
        if sheet.opaque and view.scene.image is None and not hidden:
            layer.colour[rows] = line
        drawn = [sheet.opaque] * -(-view.width // CELL)
        for thing, box, found in zip(sheet.things, boxes, each, strict=True):
            for cells, full in runs(found[number].tolist()):
                part = both((rows, slice(cells.start * CELL, cells.stop * CELL)), box)
                if part is None:
                    continue
                if full:
                    _fill(layer, thing, view, part)
                if full or _add(layer, thing, view, part, empty=not any(drawn[cells])):
                    drawn[cells] = [True] * len(drawn[cells])
    return layer


def _states(thing: Thing, view: View) -> States:
    """What a thing does to every cell of the picture."""
    height = band(view.width)
    rows, columns = (
        np.arange(0.0, length, side) + (side - 1) / 2.0
        for length, side in ((view.height, height), (view.width, CELL))
    )
    place = _own_axes(thing, view, rows, columns)
    return states(CLOSEST[thing.shape](thing, *place), math.hypot(height, CELL) / 2.0)


def _bare(sheet: Sheet, view: View) -> Layer:
    """A layer on which nothing is drawn yet; a picture that is not kept will be drawn upon."""
    scene, shape = view.scene, (view.height, view.width)
    depth = math.inf if sheet.depth is None else sheet.depth
    if not sheet.opaque:
        colour, cover = (np.zeros((*shape, channels), view.precision) for channels in (3, 1))
        return Layer(colour, cover, depth, sheet.motion)
    if scene.image is not None:
        image = scene.image.astype(view.precision, copy=bool(sheet.things))
        return Layer(image, depth=scene.depth)
    return Layer(np.empty((*shape, 3), view.precision), depth=depth, motion=sheet.motion)
