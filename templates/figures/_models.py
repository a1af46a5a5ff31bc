"""The house, the balloon and the sun that the camera simulator photographs: equally large models.

Each is about 40 wide and 50 high before it is scaled, full of fine detail that blur takes away, and
stands out from sky and meadow on a grey print, too.
"""

from __future__ import annotations

from typing import Any

from quizgen.camera import Length, SceneObject
from quizgen.camera.setup.scene import Colour

Parts = tuple[SceneObject, ...]


def light(paint: str) -> Colour:
    """Linear radiance of a colour that is written as on the screen, such as ``#e7b93c``."""
    codes = [int(paint[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    linear = [
        code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4 for code in codes
    ]
    red, green, blue = (round(value, 4) for value in linear)
    return red, green, blue


SKY = light("#9fc3e6")
_MEADOW, _HILL = light("#6f9a4e"), light("#7fa58c")


_PLAIN = {"texture", "angle", "count", "depth"}


def make_thing(
    shape: str, x: float, y: float, size: float, paint: str, **named: Any
) -> SceneObject:
    """A thing of a colour at a place in px; its lengths and points are numbers, and are scaled."""
    other = light(named.pop("other", "#000000"))
    points = tuple((size * across, size * down) for across, down in named.pop("points", ()))
    for name in named.keys() - _PLAIN:
        named[name] = Length(size * named[name])
    return SceneObject(
        shape, Length(x), Length(y), colour=light(paint), other=other, points=points, **named
    )


def house(x: float, y: float, size: float = 1.0) -> Parts:
    """A timbered house; x and y are its centre in px."""

    def part(shape: str, across: float, down: float, paint: str, **named: Any) -> SceneObject:
        return make_thing(shape, x + size * across, y + size * down, size, paint, **named)

    beams = [(across, 9.5, 2.0, 27.0) for across in (-16.0, -4.0, 4.0, 16.0)]
    beams += [(0.0, down, 34.0, 2.0) for down in (-3.0, 9.0, 22.0)]
    panes = [(across, down) for across in (-10.0, 10.0) for down in (3.0, 15.5)]
    return (
        part("box", 12, -17, "#7a4336", width=5, height=14),
        part("box", 0, 9.5, "#f6ecd6", width=34, height=27),
        *(part("box", a, d, "#4a3020", width=w, height=h) for a, d, w, h in beams),
        *(part("box", a, d, "#1d3557", width=7, height=7.5) for a, d in panes),
        *(part("box", a, d, "#f6ecd6", width=1.4, height=7.5) for a, d in panes),
        *(part("box", a, d, "#f6ecd6", width=7, height=1.4) for a, d in panes),
        part("polygon", 0, 0, "#b3382a", points=((-21, -3), (-13, -23), (13, -23), (21, -3)),
             texture="stripes", cell=4.2, other="#5f1712"),
        part("box", 0, 16.5, "#8a2f24", width=5.5, height=12),
    )  # fmt: skip


def balloon(x: float, y: float, size: float = 1.0) -> Parts:
    """A hot-air balloon; x and y are its centre in px."""

    def part(shape: str, across: float, down: float, paint: str, **named: Any) -> SceneObject:
        return make_thing(shape, x + size * across, y + size * down, size, paint, **named)

    gores = ((40.0, "#b0246e"), (31.0, "#f7dc6f"), (22.0, "#b0246e"), (13.0, "#f7dc6f"),
             (5.0, "#b0246e"))  # fmt: skip
    ropes = (((-8, 12), (-7, 11), (-2.6, 21), (-3.6, 21)), ((8, 12), (7, 11), (2.6, 21), (3.6, 21)))
    return (
        *(part("polygon", 0, 0, "#3a2418", points=rope) for rope in ropes),
        *(part("ellipse", 0, -5, paint, width=wide, height=40) for wide, paint in gores),
        part("box", 0, -5, "#f8f4e6", width=38.5, height=6, texture="checker", cell=3,
             other="#2b1a55"),
        part("box", 0, 22, "#c58b4b", width=9, height=6, texture="checker", cell=1.5,
             other="#3a2418"),
    )  # fmt: skip


def sun(x: float, y: float, size: float = 1.0) -> Parts:
    """A sun with a face; x and y are its centre in px."""

    def part(shape: str, across: float, down: float, paint: str, **named: Any) -> SceneObject:
        return make_thing(shape, x + size * across, y + size * down, size, paint, **named)

    smile = ((-7, 3.5), (-4, 5.5), (0, 6.3), (4, 5.5), (7, 3.5), (5, 7.5), (0, 9.5), (-5, 7.5))
    return (
        part("blades", 0, 0, "#d9480f", count=16, radius=22, stroke=3.2),
        part("disc", 0, 0, "#d9480f", radius=15),
        part("disc", 0, 0, "#ffe27a", radius=13.4),
        *(part("disc", side * 5, -3.5, "#40210a", radius=1.9) for side in (-1, 1)),
        *(part("disc", side * 8.5, 2.5, "#f2994a", radius=2) for side in (-1, 1)),
        part("polygon", 0, 0, "#8f1d12", points=smile),
    )


def meadow(wide: float, high: float, horizon: float) -> Parts:
    """Hills and grass behind everything, from ``horizon`` px below the middle on downwards."""
    size = wide / 144
    low = high / 2 - horizon
    return (
        SceneObject("ellipse", x=Length(-wide / 4), y=Length(horizon), colour=_HILL,
              width=Length(0.9 * wide), height=Length(22 * size)),
        SceneObject("ellipse", x=Length(wide / 3), y=Length(horizon), colour=_HILL,
              width=Length(0.8 * wide), height=Length(15 * size)),
        SceneObject("box", y=Length(horizon + low), width=Length(2 * wide), height=Length(2 * low),
              colour=_MEADOW),
    )  # fmt: skip


MODELS = (house, balloon, sun)
