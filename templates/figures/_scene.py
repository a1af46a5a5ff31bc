"""A small painted landscape: a picture of palette indices and its palette.

It holds red, orange, yellow, green, cyan, blue and magenta things, greys and near-whites, so that
every edit of hue, saturation or value shows; an edit of the colours changes the palette only. It is
painted twice as fine as it is shown, so that edges are smooth. All arithmetic is +, -, *, / and
comparison: the pixels are the same on every machine.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from quizgen.numerics.hsv import hsv_to_rgb

Colour = tuple[int, int, int]
Codes = NDArray[np.uint8]
Plane = NDArray[np.float64]
Point = tuple[float, float]

HEIGHT, WIDTH = 134, 288
SCENES = 8
_FINE = 2
"""Painted pixels beside each other in one that is shown."""
_STEP = 20
"""Codes between neighbouring mixed colours, which stand at smooth edges."""
_BANDS = 16

_PAINTS: dict[str, tuple[float, float, float]] = {
    **{f"sky {i}": (212 - 0.6 * i, 0.64 - 0.032 * i, 0.84 + 0.009 * i) for i in range(_BANDS)},
    "halo": (50, 0.24, 0.97), "glow": (49, 0.50, 0.99), "sun": (48, 0.82, 1.00),
    "cloud": (210, 0.03, 0.99), "cloud foot": (214, 0.09, 0.91),
    "far mountain": (226, 0.26, 0.76), "mountain": (232, 0.36, 0.60), "snow": (220, 0.05, 0.97),
    "far hill": (148, 0.40, 0.58), "hill": (128, 0.48, 0.56), "fir": (150, 0.62, 0.33),
    "meadow 0": (104, 0.60, 0.60), "meadow 1": (98, 0.63, 0.67), "meadow 2": (92, 0.66, 0.74),
    "lake": (188, 0.52, 0.78), "ripple": (186, 0.24, 0.93), "shore": (46, 0.38, 0.82),
    "verge": (0, 0.0, 0.42), "road": (0, 0.0, 0.55), "mark": (0, 0.0, 0.90),
    "wall": (38, 0.10, 0.98), "wall in shade": (36, 0.18, 0.83), "roof": (8, 0.82, 0.82),
    "tile": (6, 0.84, 0.66), "roof in shade": (4, 0.84, 0.55), "brick": (14, 0.55, 0.55),
    "door": (26, 0.72, 0.52), "pane": (200, 0.50, 0.62), "frame": (0, 0.0, 0.98),
    "leaf": (118, 0.62, 0.46), "lit leaf": (104, 0.64, 0.60), "trunk": (26, 0.55, 0.38),
    "magenta": (318, 0.70, 0.85), "dark magenta": (318, 0.76, 0.66), "yellow": (48, 0.80, 0.98),
    "dark yellow": (44, 0.84, 0.82), "basket": (24, 0.62, 0.46), "rope": (20, 0.40, 0.30),
    "orange": (24, 0.90, 0.97), "red": (354, 0.84, 0.86), "heart": (52, 0.85, 1.00),
}  # fmt: skip
"""Hue in degrees, saturation and value of everything."""
_INDEX = {name: place for place, name in enumerate(_PAINTS)}


def _mix_paints() -> Codes:
    hues, saturations, values = np.array(list(_PAINTS.values())).T
    channels = np.stack(hsv_to_rgb(hues, saturations, values), axis=1)
    return np.asarray(channels * 255 + 0.5).astype(np.uint8)


@cache
def paint_scene(scene: int) -> tuple[Codes, tuple[Colour, ...]]:
    """Paint a scene.

    Parameters
    ----------
    scene : int
        0 to 7: bit 0 mirrors it, bit 1 moves the house, bit 2 moves the balloon.

    Returns
    -------
    indices : ndarray of uint8, shape (134, 288)
        Of the palette.
    palette : tuple of (red, green, blue)
        At most 256 colours, 0 to 255.
    """
    painter = _Painter()
    _paint_sky(painter)
    _paint_mountains(painter)
    _paint_balloon(painter, 156.0 if scene & 4 else 102.0)
    _paint_land(painter)
    _paint_house(painter, 30.0 if scene & 2 else 0.0)
    _paint_flowers(painter)
    indices, palette = _smooth_edges(painter.picture)
    return (indices[:, ::-1].copy() if scene & 1 else indices), palette


def _smooth_edges(picture: Codes) -> tuple[Codes, tuple[Colour, ...]]:
    """Indices of a picture half as fine, and its palette: paints, then mixed colours."""
    paints = _mix_paints()
    blocks = picture.reshape(HEIGHT, _FINE, WIDTH, _FINE).swapaxes(1, 2).reshape(HEIGHT, WIDTH, -1)
    mixed = (blocks != blocks[..., :1]).any(axis=2)
    sums = paints.astype(np.int64)[blocks[mixed]].sum(axis=1)
    step = _STEP * _FINE**2
    steps = (2 * sums + step) // (2 * step)
    keys, places = np.unique(steps @ [10000, 100, 1], return_inverse=True)
    colours = np.minimum(_STEP * np.stack([keys // 10000, keys // 100 % 100, keys % 100], 1), 255)
    indices = blocks[..., 0].copy()
    indices[mixed] = len(paints) + places
    palette = np.concatenate([paints, colours]).tolist()
    return indices, tuple((red, green, blue) for red, green, blue in palette)


class _Painter:
    """A picture that paints are laid upon; places are pixels from the upper left corner."""

    def __init__(self) -> None:
        self.picture = np.zeros((_FINE * HEIGHT, _FINE * WIDTH), np.uint8)

    def window(self, box: tuple[float, ...]) -> tuple[Codes, Plane, Plane]:
        """Part of the picture about a box (left, top, right, bottom), and its places x and y."""
        left, top, right, foot = (
            min(max(int(_FINE * side) + more, 0), _FINE * most)
            for side, more, most in zip(box, (-1, -1, 2, 2), (WIDTH, HEIGHT) * 2, strict=True)
        )
        x = (np.arange(left, right) + 0.5) / _FINE
        y = (np.arange(top, foot)[:, None] + 0.5) / _FINE
        return self.picture[top:foot, left:right], x, y

    def box(self, paint: str, left: float, top: float, right: float, foot: float) -> None:
        part, x, y = self.window((left, top, right, foot))
        part[(x >= left) & (x < right) & (y >= top) & (y < foot)] = _INDEX[paint]

    def disc(self, paint: str, x: float, y: float, rx: float, ry: float = 0.0) -> None:
        """An ellipse with its radii, or a circle with one."""
        ry = ry or rx
        part, across, down = self.window((x - rx, y - ry, x + rx, y + ry))
        part[((across - x) / rx) ** 2 + ((down - y) / ry) ** 2 <= 1] = _INDEX[paint]

    def polygon(self, paint: str, *corners: Point) -> None:
        """A convex one, its corners clockwise as seen."""
        xs, ys = zip(*corners, strict=True)
        part, x, y = self.window((min(xs), min(ys), max(xs), max(ys)))
        inside = np.ones(part.shape, bool)
        for (ax, ay), (bx, by) in zip(corners, (*corners[1:], corners[0]), strict=True):
            inside &= (bx - ax) * (y - ay) >= (by - ay) * (x - ax)
        part[inside] = _INDEX[paint]


def _paint_sky(painter: _Painter) -> None:
    for band in range(_BANDS):
        painter.box(f"sky {band}", 0, 5.6 * band, WIDTH, 5.6 * (band + 1))
    for paint, radius in (("halo", 22), ("glow", 18), ("sun", 14.5)):
        painter.disc(paint, 42, 27, radius)
    for x, y, size in ((226, 30, 1.0), (252, 55, 0.55), (82, 14, 0.5)):
        for dx, dy, rx, ry in ((0, 4, 33, 5), (-14, 0, 15, 8), (4, -5, 17, 11), (19, 0, 13, 7)):
            painter.disc("cloud", x + size * dx, y + size * dy, size * rx, size * ry)
        painter.disc("cloud foot", x + 2 * size, y + 7.5 * size, 26 * size, 2.6 * size)


def _paint_mountains(painter: _Painter) -> None:
    for paint, x, top, half in (("far mountain", 96, 54, 58), ("far mountain", 206, 56, 66),
                                ("mountain", 60, 60, 48), ("mountain", 148, 48, 54),
                                ("far mountain", 262, 62, 44)):  # fmt: skip
        painter.polygon(paint, (x, top), (x + half, 96), (x - half, 96))
        slope = half / (96 - top)
        for left, middle, right, depth in ((-1, -0.5, -0.05, 9), (-0.4, 0.1, 0.55, 12),
                                           (0.12, 0.62, 1, 8)):  # fmt: skip
            low, wide = top + depth, slope * depth
            painter.polygon("snow", (x, top), (x + wide * right, low - 1.5),
                            (x + wide * middle, low), (x + wide * left, low - 1.5))  # fmt: skip


def _paint_balloon(painter: _Painter, x: float) -> None:
    y = 33.0
    for side in (-1, 1):
        top, foot = x + side * 9, x + side * 3.4
        painter.polygon("rope", (top - 0.5, y + 17), (top + 0.5, y + 17), (foot + 0.5, y + 33),
                        (foot - 0.5, y + 33))  # fmt: skip
    gores = ((20.0, "dark magenta"), (16.5, "dark yellow"), (12.0, "magenta"), (7.5, "yellow"),
             (2.8, "magenta"))  # fmt: skip
    for half, paint in gores:
        painter.disc(paint, x, y, half, 22.5)
    painter.box("basket", x - 4.2, y + 31, x + 4.2, y + 37.5)
    painter.box("rope", x - 4.2, y + 31, x + 4.2, y + 32.2)


def _paint_land(painter: _Painter) -> None:
    for paint, x, y, rx, ry in (("far hill", 60, 134, 150, 56), ("far hill", 262, 128, 110, 46),
                                ("hill", 190, 150, 190, 68)):  # fmt: skip
        painter.disc(paint, x, y, rx, ry)
    for x, foot, size in ((112, 91, 0.8), (120, 89, 1.0), (128, 89, 0.75), (136, 87, 0.9),
                          (266, 92, 0.9), (275, 94, 1.15)):  # fmt: skip
        for top, half in ((16, 4.0), (12, 5.4), (8, 6.6)):
            low = foot - size * (top - 8)
            painter.polygon(
                "fir", (x, low - 10 * size), (x + half * size, low), (x - half * size, low)
            )
    for number, (y, ry) in enumerate(((158, 66), (164, 62), (174, 58))):
        painter.disc(f"meadow {number}", 130, y, 290, ry)
    _paint_lake(painter)
    _paint_road(painter)
    painter.box("trunk", 15.5, 88, 19.5, 104)
    for dx, dy, radius in ((0, 0, 13.0), (-8, 4, 9.0), (8, 4, 9.0)):
        painter.disc("leaf", 17.5 + dx, 79 + dy, radius)
    for dx, dy, radius in ((3, -5, 6.5), (-6, 0, 4.5), (10, 1, 4)):
        painter.disc("lit leaf", 17.5 + dx, 79 + dy, radius)


def _paint_lake(painter: _Painter) -> None:
    painter.disc("shore", 126, 110, 35, 7.6)
    painter.disc("lake", 126, 110.4, 32.5, 6.2)
    for x, y, half in ((114, 108, 9), (134, 110.4, 11), (122, 113, 8)):
        painter.disc("ripple", x, y, half, 0.7)


def _paint_road(painter: _Painter) -> None:
    """From the lower left up to the house, wider towards the front."""
    part, x, y = painter.window((0, 98, WIDTH, HEIGHT))
    near = (y - 98) / (HEIGHT - 98)
    middle = 218 - 190 * near + 42 * near * near
    for paint, half in (("verge", 3.0 + 22 * near), ("road", 2.4 + 19 * near)):
        part[(abs(x - middle) < half) & (near > 0)] = _INDEX[paint]
    along = 7 * near / (0.35 + near)  # dashes get shorter with distance
    dashes = (along * 2) % 1 < 0.55
    part[(abs(x - middle) < 0.25 + 1.3 * near) & dashes & (near > 0.04)] = _INDEX["mark"]


def _paint_house(painter: _Painter, shift: float) -> None:
    left, foot = 182.0 + shift, 105.0
    top = foot - 27
    painter.box("brick", left + 42, top - 24, left + 48, top - 6)
    painter.box("wall", left, top, left + 38, foot)
    painter.box("wall in shade", left + 38, top, left + 62, foot)
    gable, ridge = (left + 19, top - 20), (left + 52, top - 20)
    painter.polygon("wall", gable, (left + 38, top + 0.5), (left, top + 0.5))
    painter.polygon("roof", gable, ridge, (left + 66, top + 1), (left + 39.5, top + 1))
    for row in range(1, 5):
        y = top - 20 + 4.2 * row
        start, stop = left + 19 + 4.1 * row, left + 52 + 2.8 * row
        painter.polygon(
            "tile", (start, y - 0.5), (stop, y - 0.5), (stop, y + 0.5), (start, y + 0.5)
        )
    painter.polygon(
        "roof in shade", gable, (left + 22.5, top - 20), (left - 0.5, top + 2), (left - 4, top + 2)
    )
    painter.polygon(
        "roof in shade",
        (gable[0] - 3, top - 20),
        gable,
        (left + 42, top + 2),
        (left + 38.5, top + 2),
    )
    painter.box("door", left + 15, foot - 15, left + 23, foot)
    for x, y, wide in ((4, top + 8, 8), (26, top + 8, 8), (44, top + 8, 11), (15.5, top - 9, 7)):
        _paint_window(painter, left + x, y, wide)


def _paint_window(painter: _Painter, x: float, y: float, wide: float) -> None:
    painter.box("frame", x - 0.8, y - 0.8, x + wide + 0.8, y + 8.8)
    painter.box("pane", x, y, x + wide, y + 8)
    painter.box("frame", x + wide / 2 - 0.5, y, x + wide / 2 + 0.5, y + 8)
    painter.box("frame", x, y + 3.5, x + wide, y + 4.5)


def _paint_flowers(painter: _Painter) -> None:
    for i in range(13):
        x, y = 128 + 12.2 * i, 117 + (i * 37) % 13
        painter.box("leaf", x - 0.5, y, x + 0.5, y + 6)
        painter.disc(("orange", "red", "orange")[i % 3], x, y, 3.4, 3.0)
        painter.disc("heart", x, y, 1.2)
