"""Lateral colour: red magnified, blue reduced, green stays."""

from __future__ import annotations

import numpy as np
from msgspec.structs import replace

from quizgen.camera.effects.effect import (
    Effect,
    LayerByLayer,
    Size,
)
from quizgen.camera.filters import sample_grid
from quizgen.camera.raster.draw import Box, Layer
from quizgen.camera.raster.layers import bound_shift, farthest, worked_on
from quizgen.camera.raster.uneven import places
from quizgen.camera.scene import Image, SceneError
from quizgen.camera.setup.settings import Setting
from quizgen.camera.setup.values import quantity
from quizgen.camera.view import View

LATERAL_COLOUR = Setting("lateral_colour", quantity("px"), 0.0)
"""Shift of red outward and blue inward at the picture's corner, px."""


MOST = 0.5
"""Largest shift as a share of the distance to the corner: blue is then magnified twice."""


def check(view: View) -> None:
    """Colours may not shrink to a point, nor turn inside out."""
    if _share(view) > MOST:
        raise SceneError(
            f"lateral_colour of {_shift(view):g} px is more than half of the "
            f"{view.frame_corner:.4g} px to the corner of the picture"
        )


def _scales(view: View) -> tuple[float, float, float]:
    """Magnification of red, green, blue."""
    share = view.camera[LATERAL_COLOUR] / view.frame_corner
    return 1.0 + share, 1.0, 1.0 - share


def work(layer: Layer, view: View) -> Layer:
    """Magnify a layer's colours differently."""
    far = _farthest(view)
    where = places(layer, (far, far))
    if layer.cover is not None:  # a cover for each colour
        cover = np.broadcast_to(layer.cover, layer.colour.shape)
        layer = replace(layer, cover=cover, own=False)

    def split(images: list[Image], box: Box) -> list[Image]:
        return [_split(image, view, box) for image in images]

    return worked_on(layer, where, split)


def _split(image: Image, view: View, box: Box) -> Image:
    result = np.empty(image[box].shape, image.dtype)
    for channel in range(3):
        _scale(image[..., channel], view, channel, box, result[..., channel])
    return result


def _scale(plane: Image, view: View, channel: int, box: Box, into: Image) -> None:
    """Magnify what one channel shows in a box."""
    scale = _scales(view)[channel]
    if scale == 1.0:
        into[...] = plane[box]
        return
    x, y = view.centre
    across = np.arange(view.width, dtype=np.float64)[box[1]] - x
    down = np.arange(view.height, dtype=np.float64)[box[0]] - y
    sample_grid(plane, across / scale + x, down / scale + y, into)


def _shift(view: View) -> float:
    shift = view.camera[LATERAL_COLOUR]
    return abs(shift)


def _share(view: View) -> float:
    return _shift(view) / view.frame_corner


def _farthest(view: View) -> float:
    """How far a colour is moved at the corner of the picture, px."""
    share = _share(view)
    return share / (1.0 - share) * view.corner


def outside(view: View) -> tuple[float, float]:
    """The reduced colour comes from beside the frame."""
    share, (x, y) = _share(view), view.centre
    beside = share / (1.0 - share)
    return farthest(view, lambda _: (x * beside, y * beside))


EFFECT = Effect(
    name="lateral colour",
    stage="optics",
    answers=("lateral colour", "artefacts"),
    settings=(LATERAL_COLOUR,),
    is_present=lambda view: view.camera[LATERAL_COLOUR] != 0.0,
    outside=outside,
    check=check,
    run=LayerByLayer(work),
    omission_bound=lambda signal, view: bound_shift(signal, view, _farthest(view)),
    size=Size(_farthest, "move red and blue by up to {:.3g} px", 1.0),
)
