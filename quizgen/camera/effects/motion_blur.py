"""Motion blur: the average over the exposure."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.body import SHUTTER
from quizgen.camera.costs import at_least_a_call, convolution, sampling
from quizgen.camera.draw import Layer, Motion, Sheet, sheets
from quizgen.camera.effect import Effect, LayerByLayer, Rung
from quizgen.camera.facts import Error, Facts
from quizgen.camera.kernels import Kernel, change, line
from quizgen.camera.layers import (
    anything_moves,
    blurred,
    chord,
    each,
    farthest,
    mixed_axes,
    path,
    rim,
    turned,
    within,
)
from quizgen.camera.view import View

MOST_TURNS = 64


def turns(motion: Motion, shutter: float, rung: str = "") -> int:
    """Samples of a rotating layer: at most 1 px apart at its rim, `MOST_TURNS` at most."""
    count = min(MOST_TURNS, max(1, math.ceil(abs(motion.spin) * shutter * motion.reach)))
    return max(1, count // 2) if rung == "half" else count


def _streak(motion: Motion, view: View) -> Kernel:
    return line(*path(motion, view, view.camera[SHUTTER]))


def work(layer: Layer, view: View, rung: str = "") -> Layer:
    """A box along straight paths, sampled positions for rotation (every second by ``half``)."""
    motion, shutter = layer.motion, view.camera[SHUTTER]
    moved = blurred(layer, _streak(motion, view))
    if not motion.spin:
        return moved
    count = turns(motion, shutter, rung)
    angles = ((np.arange(count) + 0.5) / count - 0.5) * motion.spin * shutter
    return turned(moved, angles.tolist(), chord(motion, view, shutter / 2))


def skipped(facts: Facts, view: View) -> Error:
    """What the box along the path can change, and the chord for rotation."""
    total = 0.0
    for layer, sheet, most in each(facts, view):
        total += change(_streak(sheet.motion, view), layer.jump, layer.bend, most)
        total += chord(sheet.motion, view, view.camera[SHUTTER] / 2) * math.hypot(*layer.jump)
    return within(total, facts)


def outside(view: View) -> tuple[float, float]:
    """Half the path to either side, and as far as things turn."""
    shutter = view.camera[SHUTTER]

    def reach(sheet: Sheet) -> tuple[float, float]:
        moves = path(sheet.motion, view, shutter)
        across, down = (abs(part) / 2.0 + bool(part) for part in moves)
        turn = chord(sheet.motion, view, shutter / 2.0)
        return across + turn, down + turn

    return farthest(view, reach)


def half(facts: Facts, view: View) -> Error:
    """Both sets of positions lie within half a sample of the continuous path."""
    total, shutter = 0.0, view.camera[SHUTTER]
    for layer, sheet, _ in each(facts, view):
        moves = sheet.motion
        apart = 0.5 / turns(moves, shutter) + 0.5 / turns(moves, shutter, "half")
        total += apart * abs(moves.spin) * shutter * rim(moves, view) * math.hypot(*layer.jump)
    return within(total, facts)


def after(facts: Facts, view: View) -> Facts:
    """Averages do not steepen; rotation mixes the axes."""
    turning = any(sheet.motion.spin for sheet in sheets(view))
    return mixed_axes(facts, 1.0) if turning else facts.stepped(1.0, 1.0)


def cost(view: View, rung: str, opencv_used: bool) -> float:
    """A convolution per layer, and a sample per rotated position."""
    total = 0.0
    for sheet in sheets(view):
        total += convolution(_streak(sheet.motion, view), view, opencv_used)
        if sheet.motion.spin:
            positions = turns(sheet.motion, view.camera[SHUTTER], rung)
            total += positions * 1.8 * sampling(view, opencv_used)
    return total


EFFECT = Effect(
    name="motion blur",
    stage="optics",
    decides=("motion blur", "motion", "artefacts"),
    present=lambda view: view.camera[SHUTTER] > 0.0 and anything_moves(view),
    run=LayerByLayer(work),
    cost=at_least_a_call(cost),
    skipped=skipped,
    outside=outside,
    after=after,
    rungs=(Rung("half", half),),
)
