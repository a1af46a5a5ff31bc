"""Quantisation: the codes of the converter."""

from __future__ import annotations

import math

import numpy as np

from quizgen.camera.effect import Effect, EffectSize, PointByPoint
from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import Setting, in_range
from quizgen.camera.setup.value_parsers import parse_integer
from quizgen.camera.setup.view import View

BIT_DEPTH = Setting[int | None]("bit_depth", parse_integer, None, (in_range(1, 16),))
"""Bits of the converter; None is analog."""


def _largest_code(view: View) -> int:
    """Return the largest code of the camera's converter."""
    return (1 << (view.camera[BIT_DEPTH] or 16)) - 1


def operation(view: View) -> TileOperation:
    """Return what clips a tile to [0, 1] and rounds it to the converter's codes, halves upward."""
    top = float(_largest_code(view))

    def encode_values(part: Image, _: Tile) -> None:
        """Round a tile in place."""
        part *= top
        part += 0.5
        np.floor(part, out=part)
        np.clip(part, 0.0, top, out=part)
        part /= top

    return encode_values


def _code_step(view: View) -> float:
    """Return the distance of two codes, 1 = full scale."""
    return 1.0 / _largest_code(view)


EFFECT = Effect(
    name="quantisation",
    answers=("quantisation", "bit depth"),
    settings=(BIT_DEPTH,),
    is_present=lambda view: view.camera[BIT_DEPTH] is not None,
    run=PointByPoint(operation),
    omission_bound=lambda signal, view: _code_step(view) / 2.0 + signal.outside(0.0, 1.0),
    # any difference may become a whole code
    carry_error=lambda error, _, view: (
        math.ceil(error / _code_step(view) - 1e-9) * _code_step(view)
    ),
    range_after=lambda signal, view: signal.with_margins(
        _code_step(view) / 2, _code_step(view) / 2
    ).clip_range(0, 1),
    size=EffectSize(lambda view: _largest_code(view) + 1.0, "leave {:.5g} levels"),
)
