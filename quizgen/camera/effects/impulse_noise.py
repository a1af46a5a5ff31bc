"""Impulse noise: salt and pepper on the finished picture."""

from __future__ import annotations

from quizgen.camera.blocks import Tile, Work
from quizgen.camera.effects.effect import Effect, PointByPoint, Size
from quizgen.camera.noise import Luck, luck
from quizgen.camera.scene import Image
from quizgen.camera.setup.settings import SHARE, Setting
from quizgen.camera.setup.values import quantity
from quizgen.camera.view import Signal, View

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


def work(view: View) -> Work:
    """`impulses` of the camera's share."""
    return impulses(view.camera[IMPULSE_NOISE], luck(view, "impulse noise"))


EFFECT = Effect(
    name="impulse noise",
    stage="edit",
    answers=("impulse noise", "noise", "snr", "histogram"),
    settings=(IMPULSE_NOISE,),
    is_present=lambda view: view.camera[IMPULSE_NOISE] > 0.0,
    run=PointByPoint(work),
    omission_bound=lambda signal, _: max(1.0 - signal.low, signal.high, signal.size),
    range_after=lambda signal, _: Signal(min(signal.low, 0.0), max(signal.high, 1.0)),
    size=Size(
        lambda view: 100.0 * view.camera[IMPULSE_NOISE],
        "turn {:.3g} % of the pixels black or white",
    ),
    speckles=True,
)
