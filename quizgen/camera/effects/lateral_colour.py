"""Lateral colour: red magnified, blue reduced, green stays."""

from __future__ import annotations

import numpy as np
from msgspec.structs import replace

from quizgen.camera.effect import Effect, EffectSize, LayerByLayer
from quizgen.camera.pixels.filters import sample_grid
from quizgen.camera.raster.layers import (
    bound_shift,
    largest_margin,
    remake_layer,
    sampling_reach,
)
from quizgen.camera.raster.rasterizer import Layer, PixelBox
from quizgen.camera.setup.scene import Image, SceneError
from quizgen.camera.setup.settings import Setting
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import View

LATERAL_COLOUR = Setting("lateral_colour", quantity_parser("px"), 0.0)
"""Shift of red outward and blue inward at the picture's corner, px."""


MOST = 0.5
"""Largest shift as a share of the distance to the corner: blue is then magnified twice."""


def check_camera(view: View) -> None:
    """Raise `SceneError` if a colour would shrink to a point or turn inside out."""
    if _colour_scale(view) > MOST:
        raise SceneError(
            f"lateral_colour of {_colour_scale(view) * view.frame_corner:g} px is more than half "
            f"of the {view.frame_corner:.4g} px to the corner of the picture"
        )


def operation(layer: Layer, view: View) -> Layer:
    """Return a layer with red magnified and blue reduced about the principal point."""
    far = _largest_displacement(view)
    if layer.cover is not None:  # a cover for each colour
        cover = np.broadcast_to(layer.cover, layer.colour.shape)
        layer = replace(layer, cover=cover, own=False)

    def split_colours(images: list[Image], box: PixelBox) -> list[Image]:
        """Return colour and cover of a box, each channel magnified by its own factor."""
        return [_magnify(image, view, box) for image in images]

    return remake_layer(layer, sampling_reach(layer, (far, far)), split_colours)


def _magnify(image: Image, view: View, box: PixelBox) -> Image:
    """Return what a box shows once red and blue are magnified by their own factors."""
    share, (x, y) = view.camera[LATERAL_COLOUR] / view.frame_corner, view.centre
    across = np.arange(view.width, dtype=np.float64)[box[1]] - x
    down = np.arange(view.height, dtype=np.float64)[box[0]] - y
    result = image[box].copy()
    for channel, scale in ((0, 1.0 + share), (2, 1.0 - share)):
        where = across / scale + x, down / scale + y
        sample_grid(image[..., channel], *where, result[..., channel])
    return result


def _colour_scale(view: View) -> float:
    """Return by how much red and blue differ from green in size, as a share, without sign."""
    shift = view.camera[LATERAL_COLOUR]
    return abs(shift) / view.frame_corner


def _largest_displacement(view: View) -> float:
    """Return how far a colour is moved at the corner of the picture, px."""
    share = _colour_scale(view)
    return share / (1.0 - share) * view.corner


def margin(view: View) -> tuple[float, float]:
    """Return how far outside the frame the reduced colour reads, across and down, px."""
    share, (x, y) = _colour_scale(view), view.centre
    beside = share / (1.0 - share)
    return largest_margin(view, lambda _: (x * beside, y * beside))


EFFECT = Effect(
    name="lateral colour",
    answers=("lateral colour", "artefacts"),
    settings=(LATERAL_COLOUR,),
    is_present=lambda view: view.camera[LATERAL_COLOUR] != 0.0,
    margin=margin,
    check_camera=check_camera,
    run=LayerByLayer(operation),
    omission_bound=lambda signal, view: bound_shift(signal, view, _largest_displacement(view)),
    size=EffectSize(_largest_displacement, "move red and blue by up to {:.3g} px", 1.0),
)
