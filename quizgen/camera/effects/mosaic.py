"""Mosaic: one colour per photosite."""

from __future__ import annotations

import numpy as np

from quizgen.camera.effect import Effect, on_composite
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.settings import Setting, SettingRule
from quizgen.camera.setup.value_parsers import choice_parser
from quizgen.camera.setup.view import View

TILES = ("RGGB", "BGGR", "GRBG", "GBRG")
CHANNELS = {"R": 0, "G": 1, "B": 2}


_KNOWN = SettingRule[str](lambda tile, _: tile in TILES, f"must be one of {', '.join(TILES)}")
MOSAIC = Setting("mosaic", choice_parser(*TILES), "", (_KNOWN,))
"""Colours of the 2x2 tile, rows first."""


def channel_pattern(view: View) -> tuple[tuple[int, int], ...]:
    """Return the channel (0 to 2) at each place of the 2x2 tile of the mosaic, as rows."""
    tile = [CHANNELS[letter] for letter in view.camera[MOSAIC]]
    return (tile[0], tile[1]), (tile[2], tile[3])


def run(image: Image, view: View) -> Image:
    """Return the picture with one colour per photosite, shape (H, W, 1)."""
    raw = np.empty((*image.shape[:2], 1), image.dtype)
    for row, channels in enumerate(channel_pattern(view)):
        for column, channel in enumerate(channels):
            raw[row::2, column::2, 0] = image[row::2, column::2, channel]
    return raw


EFFECT = Effect(
    name="mosaic",
    answers=("bayer", "demosaicing", "moire"),
    settings=(MOSAIC,),
    is_present=lambda view: view.camera[MOSAIC] != "",
    run=on_composite(run),
    omission_bound=lambda *_: 0.0,  # what it loses shows after demosaicing
    pair="bayer",
)
