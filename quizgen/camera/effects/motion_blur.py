"""Motion blur: the average over the exposure."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.body import SHUTTER
from quizgen.camera.costs import at_least_a_call, convolution, sampling
from quizgen.camera.draw import Layer, Motion, Stack, sheets
from quizgen.camera.effect import Effect, Rung
from quizgen.camera.facts import Error, Facts
from quizgen.camera.filters import convolve
from quizgen.camera.kernels import Kernel, change, line
from quizgen.camera.layers import (
    Field,
    anything_moves,
    chord,
    each,
    mixed_axes,
    path,
    resampled,
    rim,
    turned,
    within,
)
from quizgen.camera.scene import Image
from quizgen.camera.view import View

MOST_TURNS = 64


def turns(motion: Motion, shutter: float, rung: str = "") -> int:
    """Samples of a rotating layer: at most 1 px apart at its rim, `MOST_TURNS` at most."""
    count = min(MOST_TURNS, max(1, math.ceil(abs(motion.spin) * shutter * motion.reach)))
    return max(1, count // 2) if rung == "half" else count


def run(stack: Stack, view: View, rung: str = "") -> Stack:
    """A box along straight paths, sampled positions for rotation (every second by ``half``)."""
    return tuple(_blurred(layer, view, rung) for layer in stack)


def _streak(motion: Motion, view: View) -> Kernel:
    return line(*path(motion, view, view.camera[SHUTTER]))


def _blurred(layer: Layer, view: View, rung: str) -> Layer:
    kernel, shutter = _streak(layer.motion, view), view.camera[SHUTTER]
    moved = resampled(layer, lambda image: convolve(image, kernel))
    if not layer.motion.spin:
        return moved
    count = turns(layer.motion, shutter, rung)
    angles = ((np.arange(count) + 0.5) / count - 0.5) * layer.motion.spin * shutter
    return resampled(moved, lambda image: _mean_turned(image, view, layer.motion, angles))


def _mean_turned(image: Image, view: View, motion: Motion, angles: Field) -> Image:
    total = np.zeros_like(image)
    for angle in angles:
        total += turned(image, view, motion, float(angle))
    return total * np.float32(1.0 / len(angles))


def skipped(facts: Facts, view: View) -> Error:
    """What the box along the path can change, and the chord for rotation."""
    total = 0.0
    for layer, sheet, most in each(facts, view):
        total += change(_streak(sheet.motion, view), layer.jump, layer.bend, most)
        total += chord(sheet.motion, view, view.camera[SHUTTER] / 2) * math.hypot(*layer.jump)
    return within(total, facts)


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
    run=run,
    cost=at_least_a_call(cost),
    skipped=skipped,
    after=after,
    rungs=(Rung("half", half),),
)
