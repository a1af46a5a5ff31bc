"""Defocus: every layer blurred by the disc of its own circle of confusion."""

from __future__ import annotations

import math

import numpy as np
from msgspec.structs import replace

from quizgen.camera import focus
from quizgen.camera.body import aperture
from quizgen.camera.costs import at_least_a_call
from quizgen.camera.draw import ALL_CHANNELS, Layer
from quizgen.camera.effect import Effect, LayerByLayer, Rung
from quizgen.camera.facts import Error, Facts
from quizgen.camera.kernels import change
from quizgen.camera.layers import each, within
from quizgen.camera.view import View


def work(layer: Layer, view: View, rung: str = "") -> Layer:
    """Blur the channels of a layer that are still sharp.

    Coverage is blurred with the colour, so that a sharp layer in front keeps its edge and a
    blurred one in front lets the background shine through. The rungs ``half`` and ``quarter`` use
    fewer slices of a depth map.
    """
    depth = math.inf if isinstance(layer.depth, np.ndarray) else layer.depth
    if layer.sharp == ALL_CHANNELS:
        return replace(focus.defocused(layer, view, rung=rung), depth=depth)
    shifts = dict.fromkeys(layer.sharp, 0.0)
    return replace(focus.in_channels(layer, view, shifts, rung), depth=depth)


def skipped(facts: Facts, view: View) -> Error:
    """Sum over layers of what each layer's disc can change."""
    total = 0.0
    for layer, sheet, most in each(facts, view):
        if focus.by_depth(sheet, view):
            total += focus.map_error(layer, view)
        elif any(layer.jump):
            total += change(focus.disc_of(sheet, view), layer.jump, layer.bend, most)
    return within(total, facts)


def _fewer_slices(rung: str) -> Rung:
    return Rung(rung, lambda facts, view: focus.fewer_slices(facts, view, rung, (0.0,)))


EFFECT = Effect(
    name="defocus",
    stage="optics",
    decides=("defocus", "depth of field", "aperture", "artefacts"),
    present=lambda view: aperture(view.camera) is not None,
    check=focus.check,
    run=LayerByLayer(work),
    cost=at_least_a_call(focus.cost),
    skipped=skipped,
    outside=lambda view: focus.outside(view, (0.0,)),
    after=lambda facts, view: focus.after(facts, view, (0.0,)),
    rungs=(_fewer_slices("half"), _fewer_slices("quarter")),
)
