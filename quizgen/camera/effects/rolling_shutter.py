"""Rolling shutter: each row is read at its own time."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.effects.effect import Effect, LayerByLayer, Size
from quizgen.camera.filters import sample
from quizgen.camera.raster.draw import Box, Layer, Sheet, sheets
from quizgen.camera.raster.layers import (
    Field,
    anything_moves,
    bound_layers,
    chord,
    farthest,
    path,
    rounding,
    turned,
    worked_on,
)
from quizgen.camera.raster.uneven import places
from quizgen.camera.scene import Image
from quizgen.camera.setup.settings import NOT_NEGATIVE, Setting
from quizgen.camera.setup.values import quantity
from quizgen.camera.view import Signal, View

ROW_TIME = Setting("row_time", quantity("s"), 0.0, (NOT_NEGATIVE,))
"""Delay from row to row, s."""


def row_times(view: View) -> Field:
    """When each row is read, s, the middle row at 0."""
    rows: Field = np.arange(view.height, dtype=np.float64) - (view.height - 1) / 2
    return rows * view.camera[ROW_TIME]


def work(layer: Layer, view: View) -> Layer:
    """What moves is sheared, what turns is bent."""
    times, motion = row_times(view)[:, None], layer.motion
    if motion.spin:
        reach = chord(motion, view, float(times[-1, 0]))
        layer = turned(layer, [motion.spin * times], reach)
    across, down = path(motion, view, 1.0)
    if not across and not down:
        return layer

    def sheared(images: list[Image], box: Box) -> list[Image]:
        late = times[box[0]]
        x = np.arange(view.width)[None, box[1]] - across * late
        y = np.arange(view.height)[box[0], None] - down * late + np.zeros_like(x)
        where = _near(x, view.width, view), _near(y, view.height, view)
        return [sample(image, *where) for image in images]

    latest = float(times[-1, 0])
    far = abs(across) * latest, abs(down) * latest
    return worked_on(layer, places(layer, far), sheared)


def _near(positions: Field, length: int, view: View) -> Image:
    """Positions beyond the picture brought to its edge, which they show.

    Samplers hold no larger whole numbers than 2^31.
    """
    return np.clip(positions, -1.0, length).astype(view.precision)


def outside(view: View) -> tuple[float, float]:
    """As far as things move until the first or last row is read."""
    time = float(row_times(view)[-1])

    def reach(sheet: Sheet) -> tuple[float, float]:
        across, down = (abs(part) for part in path(sheet.motion, view, time))
        turn = chord(sheet.motion, view, time)
        return across + turn, down + turn

    return farthest(view, reach)


def omission_bound(signal: Signal, view: View) -> float:
    """How far things move until the first or last row is read, times the largest step."""
    time = float(row_times(view)[-1])

    def share(sheet: Sheet) -> float:
        across, down = (abs(part) for part in path(sheet.motion, view, time))
        near = 2.0 * rounding(view) * bool(across or down)
        return across + down + near + math.sqrt(2.0) * chord(sheet.motion, view, time)

    return bound_layers(signal, view, share)


def _farthest_apart(view: View) -> float:
    """How far anything moves from the first row to the last, px."""
    time, paths = 2.0 * float(row_times(view)[-1]), [0.0]
    for sheet in sheets(view):
        paths.append(math.hypot(*path(sheet.motion, view, time)))
        paths.append(
            2.0 * sheet.motion.reach * math.sin(min(abs(sheet.motion.spin) * time, math.pi) / 2.0)
        )
    return max(paths)


EFFECT = Effect(
    name="rolling shutter",
    stage="optics",
    answers=("rolling shutter", "motion", "artefacts"),
    settings=(ROW_TIME,),
    is_present=lambda view: view.camera[ROW_TIME] > 0.0 and anything_moves(view),
    run=LayerByLayer(work),
    omission_bound=omission_bound,
    outside=outside,
    size=Size(_farthest_apart, "move the last row by up to {:.3g} px against the first", 2.0),
    needs="something that moves",
)
