"""Rolling shutter: each row is read at its own time."""

from __future__ import annotations

import math

import numpy as np
from msgspec.structs import replace

from quizgen.camera.body import VELOCITY
from quizgen.camera.costs import at_least_a_call, sampling
from quizgen.camera.draw import Box, Layer, Sheet, sheets
from quizgen.camera.effect import Effect, LayerByLayer
from quizgen.camera.facts import Error, Facts, LayerFacts
from quizgen.camera.filters import sample
from quizgen.camera.layers import (
    Field,
    anything_moves,
    chord,
    each,
    farthest,
    path,
    rim,
    rounding,
    turned,
    within,
    worked_on,
)
from quizgen.camera.scene import Image
from quizgen.camera.settings import NOT_NEGATIVE, Setting
from quizgen.camera.uneven import places
from quizgen.camera.values import quantity
from quizgen.camera.view import View

ROW_TIME = Setting("row_time", quantity("s"), 0.0, (NOT_NEGATIVE,))
"""Delay from row to row, s."""


def row_times(view: View) -> Field:
    """When each row is read, s, the middle row at 0."""
    rows: Field = np.arange(view.height, dtype=np.float64) - (view.height - 1) / 2
    return rows * view.camera[ROW_TIME]


def work(layer: Layer, view: View, rung: str = "") -> Layer:
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


def skipped(facts: Facts, view: View) -> Error:
    """How far things move until the first or last row is read, times the steepest slope."""
    time, total = (view.height - 1) / 2 * view.camera[ROW_TIME], 0.0
    for layer, sheet, _ in each(facts, view):
        across, down = (abs(part) for part in path(sheet.motion, view, time))
        if across or down:
            across, down = across + rounding(view), down + rounding(view)
        total += across * layer.jump[0] + down * layer.jump[1]
        total += chord(sheet.motion, view, time) * math.hypot(*layer.jump)
    return within(total, facts)


def outside(view: View) -> tuple[float, float]:
    """As far as things move until the first or last row is read."""
    time = float(row_times(view)[-1])

    def reach(sheet: Sheet) -> tuple[float, float]:
        across, down = (abs(part) for part in path(sheet.motion, view, time))
        turn = chord(sheet.motion, view, time)
        return across + turn, down + turn

    return farthest(view, reach)


def after(facts: Facts, view: View) -> Facts:
    """A shear: one row down also means a row time's movement."""
    layers, time = [], view.camera[ROW_TIME]
    for layer, sheet, _ in each(facts, view):
        across, down = (abs(part) for part in path(sheet.motion, view, time))
        turn = abs(sheet.motion.spin) * time * rim(sheet.motion, view)
        x, y = layer.jump if not turn else (math.hypot(*layer.jump) * (1 + turn),) * 2
        step = x, y * (1 + down) + x * across
        layers.append(LayerFacts(step, (2 * step[0], 2 * step[1])))
    return replace(facts, layers=tuple(layers))


def cost(view: View, rung: str, opencv_used: bool) -> float:
    """A sample per layer that moves."""
    pan = view.camera[VELOCITY]
    layers = sum(1 for sheet in sheets(view) if any(pan) or not sheet.motion.still)
    return layers * 1.8 * sampling(view, opencv_used)


EFFECT = Effect(
    name="rolling shutter",
    stage="optics",
    decides=("rolling shutter", "motion", "artefacts"),
    settings=(ROW_TIME,),
    present=lambda view: view.camera[ROW_TIME] > 0.0 and anything_moves(view),
    run=LayerByLayer(work),
    cost=at_least_a_call(cost),
    skipped=skipped,
    outside=outside,
    after=after,
    needs="something that moves",
)
