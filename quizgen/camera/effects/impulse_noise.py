"""Impulse noise: salt and pepper on the finished picture."""

from __future__ import annotations

import math

from msgspec.structs import replace

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.facts import Error, Facts
from quizgen.camera.noise import Luck, luck
from quizgen.camera.scene import Image
from quizgen.camera.settings import SHARE, Setting
from quizgen.camera.values import quantity
from quizgen.camera.view import View

IMPULSE_NOISE = Setting("impulse_noise", quantity("%"), 0.0, (SHARE,))
"""Share of pixels turned black or white (half each)."""


def impulses(share: float, source: Luck) -> Work:
    """Salt and pepper: each pixel turns black or white with probability share/2 each.

    Parameters
    ----------
    share : float
        In [0, 1]. All channels of a pixel are hit together (errata EC6).
    source : Luck
    """
    if not 0.0 <= share <= 1.0:
        raise ValueError("the share of impulses lies in [0, 1]")

    def work(part: Image, tile: Tile) -> None:
        draw = source.uniform(tile.number, part.size // 3)
        pixels = part.reshape(-1, 3)
        pixels[draw < share / 2] = 0.0
        pixels[draw >= 1.0 - share / 2] = 1.0

    return work


def work(view: View, rung: str = "") -> Work:
    """`impulses` of the camera's share."""
    return impulses(view.camera[IMPULSE_NOISE], luck(view, "impulse noise"))


def skipped(facts: Facts, view: View) -> Error:
    """Any pixel may turn black or white."""
    return Error(math.inf)


def after(facts: Facts, view: View) -> Facts:
    """Steps of the whole range."""
    low, high = facts.limits
    wide = replace(facts, low=min(facts.low, 0.0), high=max(facts.high, 1.0))
    wide = replace(wide, limits=(min(low, 0.0), max(high, 1.0)))
    return wide.with_jump((wide.span, wide.span))


EFFECT = Effect(
    name="impulse noise",
    stage="edit",
    decides=("impulse noise", "noise", "snr", "histogram"),
    settings=(IMPULSE_NOISE,),
    present=lambda view: view.camera[IMPULSE_NOISE] > 0.0,
    run=PointByPoint(work),
    cost=measured((2.71, 120)),
    skipped=skipped,
    after=after,
    random=True,
)
