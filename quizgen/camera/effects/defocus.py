"""Defocus: every layer blurred by the disc of its own circle of confusion."""

from __future__ import annotations

import math

import numpy as np
from msgspec.structs import replace

from quizgen.camera.effects.effect import Effect, LayerByLayer, Size
from quizgen.camera.kernels import moved_share
from quizgen.camera.raster import focus
from quizgen.camera.raster.draw import ALL_CHANNELS, Layer, Sheet
from quizgen.camera.raster.layers import bound_layers
from quizgen.camera.setup.body import aperture
from quizgen.camera.view import Signal, View


def work(layer: Layer, view: View) -> Layer:
    """Blur the channels of a layer that are still sharp.

    Coverage is blurred with the colour, so that a sharp layer in front keeps its edge and a
    blurred one in front lets the background shine through.
    """
    depth = math.inf if isinstance(layer.depth, np.ndarray) else layer.depth
    if layer.sharp == ALL_CHANNELS:
        return replace(focus.defocused(layer, view), depth=depth)
    shifts = dict.fromkeys(layer.sharp, 0.0)
    return replace(focus.in_channels(layer, view, shifts), depth=depth)


def omission_bound(signal: Signal, view: View) -> float:
    """The light that each layer's disc takes from where it was."""

    def share(sheet: Sheet) -> float:
        if focus.is_by_depth(sheet, view):
            return focus.share_by_depth(view, 0.0)
        return moved_share(focus.disc_of(sheet, view))

    return bound_layers(signal, view, share)


EFFECT = Effect(
    name="defocus",
    stage="optics",
    answers=("defocus", "depth of field", "aperture", "artefacts"),
    is_present=lambda view: aperture(view.camera) is not None,
    check=focus.check,
    run=LayerByLayer(work),
    omission_bound=omission_bound,
    outside=lambda view: focus.outside(view, (0.0,)),
    size=Size(focus.widest_disc, "blur by discs of up to {:.3g} px", 1.5),
)
