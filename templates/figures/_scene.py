"""A small synthetic scene: a picture of palette indices and the palette.

It holds red, orange, yellow, green, cyan, blue and magenta things, greys and near-whites, so that
every edit of hue, saturation or value shows. All arithmetic is +, -, *, / and comparison: the
pixels are the same on every machine. An edit of the colours changes the palette only.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from quizgen.arrays.hsv import to_rgb

Colour = tuple[int, int, int]
Hsv = tuple[float, float, float]
Picture = NDArray[np.uint8]
Plane = NDArray[np.float64]

HEIGHT, WIDTH = 112, 240
SCENES = 8

_COLOURS: tuple[Hsv, ...] = (
    # sky, from the top down (0-7)
    *((212 / 360, 0.62 - 0.05 * i, 0.86 + 0.014 * i) for i in range(8)),
    # far hill, near meadow (8-13)
    *((150 / 360, 0.42, 0.50 + 0.05 * i) for i in range(3)),
    *((104 / 360, 0.66, 0.52 + 0.07 * i) for i in range(3)),
    (50 / 360, 0.80, 0.99),  # 14 sun
    (210 / 360, 0.03, 0.99),
    (210 / 360, 0.05, 0.93),  # 15, 16 cloud
    (0.0, 0.0, 0.52),
    (0.0, 0.0, 0.42),
    (0.0, 0.0, 0.86),  # 17-19 road, its edge, its marks
    (6 / 360, 0.82, 0.80),
    (6 / 360, 0.82, 0.62),  # 20, 21 roof
    (36 / 360, 0.10, 0.97),
    (36 / 360, 0.16, 0.84),  # 22, 23 walls
    (28 / 360, 0.75, 0.55),
    (190 / 360, 0.45, 0.80),  # 24 door, 25 window
    (318 / 360, 0.66, 0.86),
    (48 / 360, 0.78, 0.96),
    (24 / 360, 0.60, 0.45),  # 26-28 balloon
    (22 / 360, 0.88, 0.95),  # 29 flowers
)


def _palette() -> tuple[Colour, ...]:
    hues, saturations, values = np.array(_COLOURS).T
    channels = np.stack(to_rgb(hues * 360, saturations, values), axis=1)
    codes = (channels * 255 + 0.5).astype(int).tolist()
    return tuple((red, green, blue) for red, green, blue in codes)


PALETTE = _palette()
"""Colours of the unedited scene."""


@cache
def indices(scene: int) -> Picture:
    """Draw a scene.

    Parameters
    ----------
    scene : int
        0 to 7: bit 0 mirrors it, bit 1 moves the house, bit 2 moves the balloon.

    Returns
    -------
    ndarray of uint8, shape (112, 240)
        Index into ``PALETTE``.
    """
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    picture: Picture = np.minimum(y * 8 / 70, 7).astype(np.uint8)
    _sky(picture, x, y, 128.0 if scene & 4 else 88.0)
    _land(picture, x, y)
    _house(picture, x, y, 26.0 if scene & 2 else 0.0)
    return picture[:, ::-1].copy() if scene & 1 else picture


def _disc(
    x: Plane, y: Plane, at: tuple[float, float], radii: tuple[float, float]
) -> NDArray[np.bool_]:
    return ((x - at[0]) / radii[0]) ** 2 + ((y - at[1]) / radii[1]) ** 2 <= 1


def _sky(picture: Picture, x: Plane, y: Plane, balloon: float) -> None:
    picture[_disc(x, y, (34, 22), (13, 13))] = 14
    for at, radii in (((182, 30), (26, 8)), ((172, 24), (14, 9)), ((192, 23), (16, 11))):
        picture[_disc(x, y, at, radii)] = 15
    picture[_disc(x, y, (184, 34), (20, 4))] = 16
    bag = _disc(x, y, (balloon, 30), (17, 19))
    picture[bag] = 26
    picture[bag & _disc(x, y, (balloon, 30), (10, 19))] = 27
    picture[bag & _disc(x, y, (balloon, 30), (4, 19))] = 26
    picture[(abs(x - balloon) < 4) & (y > 53) & (y < 59)] = 28


def _land(picture: Picture, x: Plane, y: Plane) -> None:
    for shade, drop in ((8, 0), (9, 7), (10, 14)):
        picture[_disc(x, y, (70, 112 + drop), (120, 48))] = shade
    for shade, drop in ((11, 0), (12, 7), (13, 15)):
        picture[_disc(x, y, (170, 130 + drop), (190, 58))] = shade
    lane = (x - 40) * 0.30 + 78
    for index, half in ((18, 11), (17, 9)):
        picture[abs(y - lane) < half * (y - 60) / 40] = index
    picture[(abs(y - lane) < 1.2) & (x % 22 < 12) & (y > 70)] = 19
    for i in range(9):
        picture[_disc(x, y, (14 + 11 * i, 92 + (i * 37) % 16), (3.2, 2.6))] = 29


def _house(picture: Picture, x: Plane, y: Plane, shift: float) -> None:
    left = x - 150 - shift

    def box(start: float, stop: float, top: float, bottom: float, index: int) -> None:
        picture[(left >= start) & (left < stop) & (y >= top) & (y < bottom)] = index

    box(0, 34, 58, 84, 22)
    box(34, 54, 58, 84, 23)
    box(14, 22, 68, 84, 24)
    for start in (3, 25, 40):
        box(start, start + 6, 63, 70, 25)
    picture[(abs(left - 17) < (y - 40) * 1.15) & (y >= 40) & (y < 58)] = 20
    picture[
        (left - 17 >= (y - 40) * 1.15) & (left < 37 + (y - 40) * 1.1) & (y >= 40) & (y < 58)
    ] = 21
