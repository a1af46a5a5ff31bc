"""Pinhole geometry in the y-z plane: centre O, image plane, scene point, ray and image point.

The two similar triangles are exact as drawn. Depths are to scale while the shorter of ``f`` and
``p_z`` is 0.3 to 0.7 of the longer; otherwise the shorter one is drawn at the nearer end of that
range, and the axis has a break mark. Heights have a scale of their own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from quizgen.figures.kit import (
    Parameter,
    Values,
    format_derived,
    format_equation,
    format_statement,
    load_alt_words,
    relation_sign,
    require,
    strip_mathtext,
)
from quizgen.figures.sketch import measure_label

from ._optics import clamp, draw_lines
from ._plots import format_learned

PARAMETERS = {
    "f": Parameter("1 or mm", "focal length: distance of the image plane from O", low=1e-6),
    "p_z": Parameter("1 or m", "depth of the scene point", low=1e-6),
    "p_y": Parameter("1 or m", "height of the scene point, not 0"),
    "metric": Parameter(
        "", "0: plain numbers; 1: f and p'_y in mm, p in m; 2: all in mm", 0.0, 0.0, 2.0, whole=True
    ),
    "physical": Parameter("", "1: also draw the physical plane at -f", 0.0, 0.0, 1.0, whole=True),
    "y_down": Parameter("", "1: the y axis points down", 0.0, 0.0, 1.0, whole=True),
}
SIZE = WIDTH, HEIGHT = (312.0, 170.0)

_UNITS = {0: ("", ""), 1: ("mm", "m"), 2: ("mm", "mm")}
_LEAST, _MOST = 0.3, 0.7
# A fir, 1 wide and 1 high, about its trunk.
_FIR = np.array(
    [(0.08, 0), (0.08, 0.14), (0.5, 0.14), (0.2, 0.44), (0.38, 0.44), (0.14, 0.72), (0.26, 0.72)]
)
_FIR = np.concatenate([_FIR, [(0, 1)], _FIR[::-1] * (-1, 1)])


@dataclass(frozen=True, slots=True)
class _Layout:
    """Where things are, in points: O, the far leg, and how the near leg divides it."""

    o_x: float
    o_y: float
    length: float
    height: float
    near: float
    point_is_far: bool
    side: int
    fir: float
    to_scale: bool

    def at(self, depth: float, height: float) -> tuple[float, float]:
        return self.o_x + depth * self.length, self.o_y + self.side * height * self.height

    def beside(self, depth: float, offset: float) -> tuple[float, float]:
        """Find a place some points away from the axis, on the side of the scene point."""
        return self.o_x + depth * self.length, self.o_y + self.side * offset

    @property
    def point(self) -> float:
        return 1.0 if self.point_is_far else self.near

    @property
    def plane(self) -> float:
        return self.near if self.point_is_far else 1.0


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, hide the height of the image point.

    Raises
    ------
    BankError
        If the scene point lies on the axis or in the image plane.
    """
    require("pinhole", values["p_y"] != 0, "p_y must not be 0")
    require("pinhole", values["p_z"] != values["f"] * _scale(values), "p_z must not be f")
    art, place, words = fig.sketch(), _lay_out(values), _label_lengths(values, quiz=quiz)
    _draw_triangles(art, place)
    _draw_axes(art, place, values)
    if values["physical"]:
        _draw_physical_plane(art, place)
    _draw_distances(art, place, words)
    _draw_points(art, place, words, physical=bool(values["physical"]))


def _scale(values: Values) -> float:
    """Size of the unit of f in units of p."""
    return 1e-3 if values["metric"] == 1 else 1.0


def _image_height(values: Values) -> float:
    return float(values["f"] * values["p_y"] / values["p_z"])


def _label_lengths(values: Values, *, quiz: bool) -> dict[str, str]:
    image_unit, unit = _UNITS[int(values["metric"])]
    return {
        "f": format_statement("$f$", values["f"], image_unit),
        "p_z": format_statement("$p_z$", values["p_z"], unit),
        "p_y": format_statement("$p_y$", values["p_y"], unit),
        "image": format_equation("$p'_y$", _image_height(values), image_unit, hide=quiz),
    }


def _lay_out(values: Values) -> _Layout:
    # As wide as with the answer in it: question and solution show the same drawing.
    words = _label_lengths(values, quiz=False)
    f, p_z = values["f"] * _scale(values), values["p_z"]
    point_is_far, ratio = p_z > f, min(f, p_z) / max(f, p_z)
    far_leg, near_leg = ("p_y", "image") if point_is_far else ("image", "p_y")
    # Half the width of a tree. Questions with units name other things than trees.
    fir = 0.0 if values["metric"] == 1 else 11.0
    room = WIDTH - 34 - measure_label(words[far_leg])[0] - 12 * values["physical"] - fir
    gap = (measure_label(words[near_leg])[0] + 9 + fir) / room
    near = min(max(ratio, _LEAST), _limit_near(gap, values["physical"], point_is_far))
    left = below = values["physical"] * (near if point_is_far else 1.0)
    length = room / (1 + left)
    height = min(HEIGHT - 74, (HEIGHT - 40) / (1 + below))
    side = 1 if (values["p_y"] > 0) != (values["y_down"] == 1) else -1
    o_x = 18 + left * length + (12 if left else 0)
    return _Layout(
        o_x,
        HEIGHT / 2,
        length,
        height,
        near,
        point_is_far,
        side,
        fir * (1 if point_is_far else near),
        near == ratio,
    )


def _limit_near(gap: float, physical: float, point_is_far: bool) -> float:
    """Largest place of the near leg that leaves its label room before the far leg."""
    if not physical:
        return min(_MOST, 1 - gap)
    return min(_MOST, (1 - gap) / (1 + gap) if point_is_far else 1 - 2 * gap)


def _draw_triangles(art: Any, place: _Layout) -> None:
    tones = (("outer", 1.0, "pale-gold"), ("inner", place.near, "pale-blue"))
    for part, depth, tone in tones:
        art.area([place.at(0, 0), place.at(depth, 0), place.at(depth, depth)], tone, part=part)
    for depth in (place.point, place.plane) if place.fir else ():
        _draw_fir(art, place, depth)
    art.ray([place.at(1, 1), place.at(0, 0)], "red", heads=((0, 0.3),), part="ray")
    for part, depth in (("leg-point", place.point), ("leg-image", place.plane)):
        art.line([place.at(depth, 0), place.at(depth, depth)], "ink", 1.8, part=part)


def _draw_fir(art: Any, place: _Layout, depth: float) -> None:
    """Draw the tree that the scene point belongs to, or its image: upright, or turned over.

    A scene point above the axis is its tip; of one below, it is the foot.
    """
    upright = _FIR if place.side > 0 else (0, 1) + _FIR * (1, -1)
    wide = 2 * place.fir * depth / place.point
    corners = upright * (wide, depth * place.height * place.side) + place.at(depth, 0)
    art.area(corners, "pale-teal", "teal", 0.5, part="tree")


def _draw_axes(art: Any, place: _Layout, values: Values) -> None:
    start = 6.0 if values["physical"] else place.o_x - 10
    end = (place.o_x + place.length + 26, place.o_y)
    art.arrow((start, place.o_y), end, width=0.8, part="axis")
    art.label((end[0] + 3, place.o_y), "$z$", "l")
    reach = (-1 if values["y_down"] else 1) * (40 if values["p_y"] > 0 else 52)
    art.arrow((place.o_x, place.o_y), (place.o_x, place.o_y + reach), width=0.8, part="axis-y")
    art.label((place.o_x - 5, place.o_y + 0.92 * reach), "$y$", "r")
    top = place.height * place.plane + 9
    plane = [place.beside(place.plane, -9), place.beside(place.plane, top)]
    art.line(plane, "blue", 1.0, part="plane")
    step = 5 / place.length
    corners = [
        [place.beside(depth - step, 0), place.beside(depth - step, 5), place.beside(depth, 5)]
        for depth in (place.near, 1.0)
    ]
    draw_lines(art, corners, "grey", part="right-angles")
    if not place.to_scale:
        art.axis_break(place.at((place.near + 1) / 2, 0))


def _draw_physical_plane(art: Any, place: _Layout) -> None:
    depth = place.plane
    corners = [place.at(0, 0), place.at(-depth, 0), place.at(-depth, -depth)]
    art.area(corners, "pale-blue", part="physical")
    if place.fir:
        _draw_fir(art, place, -depth)
    art.line([corners[0], corners[2]], "red", dashes=(4, 2.5), part="physical-ray")
    ends = [place.beside(-depth, 10), place.beside(-depth, -place.height * depth - 9)]
    art.line(ends, "blue", dashes=(4, 2.5), part="physical-plane")
    art.dot(corners[2], part="points")
    art.label(place.beside(-depth, 17), "$−f$")
    art.label(corners[2], "$−p'_y$", "l", shift=(7, -3 * place.side))


def _draw_distances(art: Any, place: _Layout, words: dict[str, str]) -> None:
    near, far = ("f", "p_z") if place.point_is_far else ("p_z", "f")
    feet = ((place.near, -24), (1.0, -42), (0.0, -42))
    draw_lines(art, [[place.beside(d, -3), place.beside(d, foot)] for d, foot in feet])
    for depth, row, name in ((place.near, -19, near), (1.0, -37, far)):
        art.measure(place.beside(0, row), place.beside(depth, row), words[name], side="r")


def _draw_points(art: Any, place: _Layout, words: dict[str, str], *, physical: bool) -> None:
    for leg, depth in (("p_y", place.point), ("image", place.plane)):
        x, y = place.at(depth, 0.5 * depth)
        shift = 4 + place.fir * depth / place.point
        art.label((x, y), words[leg], "l", shift=(shift, 0))
    for depth in (0.0, place.near, 1.0):
        art.dot(place.at(depth, depth), part="points")
    near_name, far_name = ("$p'$", "$p$") if place.point_is_far else ("$p$", "$p'$")
    art.label(place.at(place.near, place.near), near_name, "r", shift=(-5, 8 * place.side))
    art.label(place.at(1, 1), far_name, "l", shift=(5, 2 * place.side))
    side = place.side if physical else -place.side
    art.label(place.at(0, 0), "O", "r", shift=(-5, 9 * side))


MARKS = {"p'_y": ""}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(fig: Any, values: Values, marks: dict[str, float]) -> None:
    """Draw the image point where a learner's ``p'_y`` puts it, and the ray that would hit it."""
    art, place = fig.sketch(zorder=6), _lay_out(values)
    value, unit = marks["p'_y"], _UNITS[int(values["metric"])][0]
    drawn = value / _image_height(values) * place.plane
    height, beyond = clamp(drawn * place.height, -34, place.height + 14)
    spot, middle = place.beside(place.plane, height), 0.5 * place.plane * place.height
    art.line([place.at(0, 0), spot], "gold", dashes=(2, 2), part="learned")
    if beyond:
        art.head(spot, (0, beyond * place.side), "gold", 9, part="learned")
    else:
        art.dot(spot, 2.6, "gold", part="learned")
    # The label stands clear of that of the right height, and between those of the depths.
    if abs(height - middle) < 11:
        height = middle + (11 if height > middle else -11)
    height = -28 if height < -8 else height
    at, text = place.beside(place.plane, height), f"{format_learned(value)} {unit}".rstrip()
    align, dx = ("l", 7) if place.point_is_far or height < 1.8 * middle else ("r", -7)
    art.label(at, text, align, fill="gold", shift=(dx, 0), halo=True, part="learned")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave the height of the image point out."""
    words = load_alt_words(__file__, lang)
    labels = _label_lengths(values, quiz=quiz)
    text: str = words["figure"].format(**{k: strip_mathtext(v) for k, v in labels.items()})
    if values["physical"]:
        text += words["physical"]
    height, unit = _image_height(values), _UNITS[int(values["metric"])][0]
    return text + words["quiz" if quiz else "answer"].format(
        relation=relation_sign(height),
        height=format_derived(height),
        unit=f" {unit}" if unit else "",
    )
