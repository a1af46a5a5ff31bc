"""Defocus: every layer blurred by the disc of its own circle of confusion."""

from __future__ import annotations

import math

import numpy as np
from msgspec.structs import replace

from quizgen.camera.effect import Effect, EffectSize, LayerByLayer
from quizgen.camera.raster import depth_blur
from quizgen.camera.raster.rasterizer import ALL_CHANNELS, Layer
from quizgen.camera.setup.settings import aperture_diameter
from quizgen.camera.setup.view import View


def operation(layer: Layer, view: View) -> Layer:
    """Return a layer with its still sharp channels blurred by its circle of confusion.

    Coverage is blurred with the colour, so that a sharp layer in front keeps its edge and a
    blurred one in front lets the background shine through.
    """
    depth = math.inf if isinstance(layer.depth, np.ndarray) else layer.depth
    if layer.sharp == ALL_CHANNELS:
        return replace(depth_blur.blur_by_depth(layer, view), depth=depth)
    shifts = dict.fromkeys(layer.sharp, 0.0)
    return replace(depth_blur.blur_channels(layer, view, shifts), depth=depth)


EFFECT = Effect(
    name="defocus",
    answers=("defocus", "depth of field", "aperture", "artefacts"),
    is_present=lambda view: aperture_diameter(view.camera) is not None,
    check_camera=depth_blur.check_blur_width,
    run=LayerByLayer(operation),
    omission_bound=depth_blur.bound_discs,
    margin=lambda view: depth_blur.blur_margin(view, (0.0,)),
    size=EffectSize(depth_blur.widest_disc, "blur by discs of up to {:.3g} px", 1.5),
)
