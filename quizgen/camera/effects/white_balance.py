"""White balance: a gain per channel."""

from __future__ import annotations

import numpy as np

from quizgen.camera.blocks import BLOCK, Tile, Work
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.facts import Error, Facts
from quizgen.camera.scene import Colour, Image
from quizgen.camera.settings import NOT_NEGATIVE, Rule, Setting, Settings
from quizgen.camera.values import triple
from quizgen.camera.view import View


def _no_gain_negative(gains: Colour, _: Settings) -> bool:
    return min(gains) >= 0.0


WHITE_BALANCE = Setting(
    "white_balance", triple, (1.0, 1.0, 1.0), (Rule(_no_gain_negative, NOT_NEGATIVE.message),)
)
"""Gains of red, green and blue."""


def work(view: View, rung: str = "") -> Work:
    """Multiply the channels by their gains."""
    gains = np.tile(np.asarray(view.camera[WHITE_BALANCE], view.precision), BLOCK // 3)

    def balanced(part: Image, _: Tile) -> None:
        part *= gains[: part.size]

    return balanced


def skipped(facts: Facts, view: View) -> Error:
    """Largest value times the gain farthest from 1."""
    factor = max(abs(gain - 1.0) for gain in view.camera[WHITE_BALANCE])
    return facts.amplified(factor)


def carried(error: Error, facts: Facts, view: View) -> Error:
    """Amplified by the largest gain."""
    gains = view.camera[WHITE_BALANCE]
    return error.amplified(min(gains), max(gains))


def after(facts: Facts, view: View) -> Facts:
    """Scaled by gains between the smallest and the largest."""
    gains = view.camera[WHITE_BALANCE]
    return facts.gained(min(gains), max(gains))


EFFECT = Effect(
    name="white balance",
    stage="processing",
    decides=("white balance",),
    settings=(WHITE_BALANCE,),
    present=lambda view: view.camera[WHITE_BALANCE] != (1.0, 1.0, 1.0),
    run=PointByPoint(work),
    cost=measured((0.283, 27.4)),
    skipped=skipped,
    carried=carried,
    knows_where=True,
    after=after,
)
