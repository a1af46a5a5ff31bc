"""Quantisation: the codes of the converter."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.effects.effect import Effect, PointByPoint, Size
from quizgen.camera.scene import Image
from quizgen.camera.setup.settings import Setting, between
from quizgen.camera.setup.values import whole
from quizgen.camera.view import Signal, View

BIT_DEPTH = Setting[int | None]("bit_depth", whole, None, (between(1, 16),))
"""Bits of the converter; None is analog."""


def _largest_code(view: View) -> int:
    return (1 << (view.camera[BIT_DEPTH] or 16)) - 1


def work(view: View) -> Work:
    """Clip to [0, 1] and round to the converter's codes, halves upward."""
    top = float(_largest_code(view))

    def coded(part: Image, _: Tile) -> None:
        part *= top
        part += 0.5
        np.floor(part, out=part)
        np.clip(part, 0.0, top, out=part)
        part /= top

    return coded


def _step(view: View) -> float:
    """One code, 1 = full scale."""
    return 1.0 / _largest_code(view)


def range_after(signal: Signal, view: View) -> Signal:
    """Half a code wider, and clipped."""
    return signal.widened(_step(view) / 2.0, _step(view) / 2.0).clipped(0.0, 1.0)


EFFECT = Effect(
    name="quantisation",
    stage="sensor",
    answers=("quantisation", "bit depth"),
    settings=(BIT_DEPTH,),
    is_present=lambda view: view.camera[BIT_DEPTH] is not None,
    run=PointByPoint(work),
    omission_bound=lambda signal, view: _step(view) / 2.0 + signal.outside(0.0, 1.0),
    # any difference may become a whole code
    carry_error=lambda error, _, view: math.ceil(error / _step(view) - 1e-9) * _step(view),
    range_after=range_after,
    size=Size(lambda view: _largest_code(view) + 1.0, "leave {:.5g} levels"),
)
