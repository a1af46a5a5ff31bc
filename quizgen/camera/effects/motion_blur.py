"""Motion blur: the average over the exposure."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, LayerByLayer
from quizgen.camera.pixels.kernels import BlurKernel, motion_kernel, moved_share
from quizgen.camera.raster.layers import (
    blur_layer,
    bound_layers,
    displacement,
    has_motion,
    largest_chord,
    largest_margin,
    rotate_layer,
)
from quizgen.camera.raster.rasterizer import Layer, LayerSpec, Motion, layer_specs
from quizgen.camera.setup.settings import SHUTTER
from quizgen.camera.setup.view import Signal, View

MOST_TURNS = 64


def rotation_samples(motion: Motion, shutter: float) -> int:
    """Return at how many times a turning layer is sampled.

    Samples lie at most 1 px apart at its rim; there are `MOST_TURNS` at most.
    """
    return min(MOST_TURNS, max(1, math.ceil(abs(motion.spin) * shutter * motion.reach)))


def _motion_kernel_of(motion: Motion, view: View) -> BlurKernel:
    """Return the kernel of a layer's straight path while the shutter is open."""
    return motion_kernel(*displacement(motion, view, view.camera[SHUTTER]))


def operation(layer: Layer, view: View) -> Layer:
    """Return a layer blurred by its motion: a box along a straight path, samples of a rotation."""
    motion, shutter = layer.motion, view.camera[SHUTTER]
    moved = blur_layer(layer, _motion_kernel_of(motion, view))
    if not motion.spin:
        return moved
    count = rotation_samples(motion, shutter)
    angles = ((np.arange(count) + 0.5) / count - 0.5) * motion.spin * shutter
    return rotate_layer(moved, angles.tolist(), largest_chord(motion, view, shutter / 2))


def margin(view: View) -> tuple[float, float]:
    """Return how far outside the frame motion brings light from, across and down, px."""
    shutter = view.camera[SHUTTER]

    def reach(spec: LayerSpec) -> tuple[float, float]:
        """Return half of a layer's path, plus what its rotation reaches, px."""
        moves = displacement(spec.motion, view, shutter)
        across, down = (abs(part) / 2.0 + bool(part) for part in moves)
        turn = largest_chord(spec.motion, view, shutter / 2.0)
        return across + turn, down + turn

    return largest_margin(view, reach)


def omission_bound(signal: Signal, view: View) -> float:
    """Return a bound: light that a path takes from its pixel, and the chord of a rotation."""

    def share(spec: LayerSpec) -> float:
        """Return how much of its range a layer can change."""
        turn = largest_chord(spec.motion, view, view.camera[SHUTTER] / 2.0)
        return moved_share(_motion_kernel_of(spec.motion, view)) + math.sqrt(2.0) * turn

    return bound_layers(signal, view, share)


def _longest_path(view: View) -> float:
    """Return the longest path of anything over the sensor while the shutter is open, px."""
    shutter, paths = view.camera[SHUTTER], [0.0]
    for spec in layer_specs(view):
        paths.append(math.hypot(*displacement(spec.motion, view, shutter)))
        paths.append(abs(spec.motion.spin) * shutter * spec.motion.reach)
    return max(paths)


EFFECT = Effect(
    name="motion blur",
    answers=("motion blur", "motion", "artefacts"),
    is_present=lambda view: view.camera[SHUTTER] > 0.0 and has_motion(view),
    run=LayerByLayer(operation),
    omission_bound=omission_bound,
    margin=margin,
    size=EffectSize(_longest_path, "smear over up to {:.3g} px", 1.5),
)
