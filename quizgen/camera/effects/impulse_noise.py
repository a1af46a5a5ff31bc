"""Impulse noise: salt and pepper on the finished picture."""

from __future__ import annotations

from quizgen.camera.effect import Effect, EffectSize, PointByPoint
from quizgen.camera.pixels.noise import EffectRandom, effect_random
from quizgen.camera.pixels.tiles import Tile, TileOperation
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import SHARE, Setting
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import View

IMPULSE_NOISE = Setting("impulse_noise", quantity_parser("%"), 0.0, (SHARE,))
"""Share of pixels turned black or white (half each)."""


def add_impulses(share: float, source: EffectRandom) -> TileOperation:
    """Return what turns pixels of a tile black or white, with the probability share/2 each.

    Parameters
    ----------
    share : float
        In [0, 1]. All channels of a pixel are hit together (errata EC6).
    source : EffectRandom
    """
    if not 0.0 <= share <= 1.0:
        raise ValueError("the share of impulses lies in [0, 1]")

    def work(part: Image, tile: Tile) -> None:
        """Set the pixels of a tile in place."""
        draw = source.draw_uniform(tile.number, part.size // 3)
        pixels = part.reshape(-1, 3)
        pixels[draw < share / 2] = 0.0
        pixels[draw >= 1.0 - share / 2] = 1.0

    return work


def operation(view: View) -> TileOperation:
    """Return what adds salt and pepper noise of the camera's share to a tile."""
    return add_impulses(view.camera[IMPULSE_NOISE], effect_random(view, "impulse noise"))


EFFECT = Effect(
    name="impulse noise",
    answers=("impulse noise", "noise", "snr", "histogram"),
    settings=(IMPULSE_NOISE,),
    is_present=lambda view: view.camera[IMPULSE_NOISE] > 0.0,
    run=PointByPoint(operation),
    omission_bound=lambda signal, _: max(1.0 - signal.low, signal.high, signal.size),
    range_after=lambda signal, _: signal.including(0.0, 1.0),
    size=EffectSize(
        lambda view: 100.0 * view.camera[IMPULSE_NOISE],
        "turn {:.3g} % of the pixels black or white",
    ),
    speckles=True,
)
