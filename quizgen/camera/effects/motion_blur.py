"""Motion blur: the average over the exposure."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.effects.effect import Effect, LayerByLayer, Size
from quizgen.camera.kernels import Kernel, line, moved_share
from quizgen.camera.raster.draw import Layer, Motion, Sheet, sheets
from quizgen.camera.raster.layers import (
    anything_moves,
    blurred,
    bound_layers,
    chord,
    farthest,
    path,
    turned,
)
from quizgen.camera.setup.body import SHUTTER
from quizgen.camera.view import Signal, View

MOST_TURNS = 64


def turns(motion: Motion, shutter: float) -> int:
    """Samples of a rotating layer: at most 1 px apart at its rim, `MOST_TURNS` at most."""
    return min(MOST_TURNS, max(1, math.ceil(abs(motion.spin) * shutter * motion.reach)))


def _streak(motion: Motion, view: View) -> Kernel:
    return line(*path(motion, view, view.camera[SHUTTER]))


def work(layer: Layer, view: View) -> Layer:
    """A box along straight paths, sampled positions for rotation."""
    motion, shutter = layer.motion, view.camera[SHUTTER]
    moved = blurred(layer, _streak(motion, view))
    if not motion.spin:
        return moved
    count = turns(motion, shutter)
    angles = ((np.arange(count) + 0.5) / count - 0.5) * motion.spin * shutter
    return turned(moved, angles.tolist(), chord(motion, view, shutter / 2))


def outside(view: View) -> tuple[float, float]:
    """Half the path to either side, and as far as things turn."""
    shutter = view.camera[SHUTTER]

    def reach(sheet: Sheet) -> tuple[float, float]:
        moves = path(sheet.motion, view, shutter)
        across, down = (abs(part) / 2.0 + bool(part) for part in moves)
        turn = chord(sheet.motion, view, shutter / 2.0)
        return across + turn, down + turn

    return farthest(view, reach)


def omission_bound(signal: Signal, view: View) -> float:
    """The light that the box along the path takes from where it was, and the chord of a turn."""

    def share(sheet: Sheet) -> float:
        turn = chord(sheet.motion, view, view.camera[SHUTTER] / 2.0)
        return moved_share(_streak(sheet.motion, view)) + math.sqrt(2.0) * turn

    return bound_layers(signal, view, share)


def _longest(view: View) -> float:
    """Longest path of anything over the sensor, px."""
    shutter, paths = view.camera[SHUTTER], [0.0]
    for sheet in sheets(view):
        paths.append(math.hypot(*path(sheet.motion, view, shutter)))
        paths.append(abs(sheet.motion.spin) * shutter * sheet.motion.reach)
    return max(paths)


EFFECT = Effect(
    name="motion blur",
    stage="optics",
    answers=("motion blur", "motion", "artefacts"),
    is_present=lambda view: view.camera[SHUTTER] > 0.0 and anything_moves(view),
    run=LayerByLayer(work),
    omission_bound=omission_bound,
    outside=outside,
    size=Size(_longest, "smear over up to {:.3g} px", 1.5),
)
