"""Rolling shutter: each row is read at its own time."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, LayerByLayer
from quizgen.camera.pixels.filters import sample_bilinear
from quizgen.camera.raster.layers import (
    Field,
    bound_layers,
    displacement,
    has_motion,
    largest_chord,
    largest_margin,
    position_error,
    remake_layer,
    rotate_layer,
    sampling_reach,
)
from quizgen.camera.raster.rasterizer import Layer, LayerSpec, PixelBox, layer_specs
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import NOT_NEGATIVE, Setting
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import Signal, View

ROW_TIME = Setting("row_time", quantity_parser("s"), 0.0, (NOT_NEGATIVE,))
"""Delay from row to row, s."""


def row_times(view: View) -> Field:
    """Return when each row is read, s; the middle row at 0."""
    rows: Field = np.arange(view.height, dtype=np.float64) - (view.height - 1) / 2
    return rows * view.camera[ROW_TIME]


def operation(layer: Layer, view: View) -> Layer:
    """Return a layer as rows see it one after another: shifts shear it, rotation bends it."""
    times, motion = row_times(view)[:, None], layer.motion
    if motion.spin:
        reach = largest_chord(motion, view, float(times[-1, 0]))
        layer = rotate_layer(layer, [motion.spin * times], reach)
    across, down = displacement(motion, view, 1.0)
    if not across and not down:
        return layer

    def shear_rows(images: list[Image], box: PixelBox) -> list[Image]:
        """Return colour and cover of a box, each row shifted by its own time."""
        late = times[box[0]]
        x = np.arange(view.width)[None, box[1]] - across * late
        y = np.arange(view.height)[box[0], None] - down * late + np.zeros_like(x)
        where = _clamp_to_edge(x, view.width, view), _clamp_to_edge(y, view.height, view)
        return [sample_bilinear(image, *where) for image in images]

    latest = float(times[-1, 0])
    far = abs(across) * latest, abs(down) * latest
    return remake_layer(layer, sampling_reach(layer, far), shear_rows)


def _clamp_to_edge(positions: Field, length: int, view: View) -> Image:
    """Return positions (px) brought back to just outside the picture, where its edge repeats.

    Samplers hold no larger whole numbers than 2^31.
    """
    return np.clip(positions, -1.0, length).astype(view.precision)


def margin(view: View) -> tuple[float, float]:
    """Return how far outside the frame the first and last rows read, across and down, px."""
    time = float(row_times(view)[-1])

    def reach(spec: LayerSpec) -> tuple[float, float]:
        """Return how far a layer moves until then, px."""
        across, down = (abs(part) for part in displacement(spec.motion, view, time))
        turn = largest_chord(spec.motion, view, time)
        return across + turn, down + turn

    return largest_margin(view, reach)


def omission_bound(signal: Signal, view: View) -> float:
    """Return the bound for how far things move until the first or last row is read."""
    time = float(row_times(view)[-1])

    def share(spec: LayerSpec) -> float:
        """Return how much of its range a layer can change."""
        across, down = (abs(part) for part in displacement(spec.motion, view, time))
        near = 2.0 * position_error(view) * bool(across or down)
        return across + down + near + math.sqrt(2.0) * largest_chord(spec.motion, view, time)

    return bound_layers(signal, view, share)


def _largest_row_shift(view: View) -> float:
    """Return how far anything moves from the first row to the last, px."""
    time, paths = 2.0 * float(row_times(view)[-1]), [0.0]
    for spec in layer_specs(view):
        paths.append(math.hypot(*displacement(spec.motion, view, time)))
        paths.append(
            2.0 * spec.motion.reach * math.sin(min(abs(spec.motion.spin) * time, math.pi) / 2.0)
        )
    return max(paths)


EFFECT = Effect(
    name="rolling shutter",
    answers=("rolling shutter", "motion", "artefacts"),
    settings=(ROW_TIME,),
    is_present=lambda view: view.camera[ROW_TIME] > 0.0 and has_motion(view),
    run=LayerByLayer(operation),
    omission_bound=omission_bound,
    margin=margin,
    size=EffectSize(
        _largest_row_shift, "move the last row by up to {:.3g} px against the first", 2.0
    ),
    needs="something that moves",
)
