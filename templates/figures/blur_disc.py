"""Blur disc: the cone of light behind a lens, cut by a sensor that is not where it is sharp.

Distances along the axis are to scale where the sensor is 0.15 to 0.6 z'_p away from the sharp
image; in cameras it is much less, and the axis is broken. Diameters have a scale of their own, on
which aperture and blur disc keep their exact proportions as drawn.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log
from typing import Any

from quizgen.figures.kit import (
    Parameter,
    Values,
    format_equation,
    format_given,
    format_statement,
    load_alt_words,
    strip_mathtext,
)

from ._optics import clamp, draw_axis, draw_lens, draw_lines
from ._plots import format_learned

PARAMETERS = {
    "D": Parameter("mm", "diameter of the aperture", low=1e-6),
    "z_p": Parameter("mm", "distance z'_p from the lens to the sharp image of the point", low=1e-6),
    "z_s": Parameter("mm", "distance z'_s from the lens to the sensor", low=1e-6),
}
SIZE = (312.0, 170.0)

_AXIS, _LENS, _RIM, _LENGTH = 108.0, 78.0, 58.0, 152.0
_ROWS = (36.0, 18.0)
_TO_SCALE = (0.15, 0.6)


@dataclass(frozen=True, slots=True)
class _Layout:
    """Drawn places in points: sharp image, sensor, half the aperture and half the blur disc."""

    apex: float
    sensor: float
    half: float
    disc: float
    to_scale: bool

    @property
    def near(self) -> float:
        return min(self.apex, self.sensor)

    @property
    def far(self) -> float:
        return max(self.apex, self.sensor)


def _lay_out(values: Values) -> _Layout:
    ratio = (values["z_s"] - values["z_p"]) / values["z_p"]
    size, (least, most) = abs(ratio), _TO_SCALE
    to_scale = not ratio or least <= size <= most
    if not to_scale:
        # Wider apart than they are, though the farther the farther: draws look different.
        size = most if size > most else 0.19 + 0.15 * _place(size, 0.003, least)
    shift = size if ratio > 0 else -size
    half = 26.0 + 22.0 * _place(values["D"] / values["z_p"], 1 / 16, 1.0)
    length = _LENGTH / max(1.0, 1 + shift)
    apex, sensor = _LENS + length, _LENS + length * (1 + shift)
    return _Layout(apex, sensor, half, half * size, to_scale)


def _place(value: float, low: float, high: float) -> float:
    """Where a value lies between two others, 0 to 1, in logarithms."""
    return min(max(log(value / low) / log(high / low), 0.0), 1.0)


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, hide the diameters of aperture and blur disc."""
    art, place = fig.sketch(), _lay_out(values)
    words = _label_lengths(values, quiz=quiz)
    _draw_light(art, place)
    art.line([(place.sensor, _AXIS - 54), (place.sensor, _AXIS + 54)], "ink", 1.0, part="sensor")
    ends = [(place.sensor, _AXIS - place.disc), (place.sensor, _AXIS + place.disc)]
    art.line(ends, "red", 3.6, part="disc")
    art.dot((place.apex, _AXIS), 2.4, part="apex")
    _draw_distances(art, place, words)
    _draw_diameters(art, place, words)


def _draw_light(art: Any, place: _Layout) -> None:
    """Draw the cone of light, and the lens and its stop that it comes from."""
    beyond = place.half * (place.far - place.apex) / (place.apex - _LENS)
    apex = (place.apex, _AXIS)
    cone = [apex, (place.far, _AXIS - beyond), (place.far, _AXIS + beyond)] if beyond else [apex]
    lens = [(_LENS, _AXIS - place.half), (_LENS, _AXIS + place.half)]
    art.area([*cone, apex, *lens], "pale-gold", part="cone")
    draw_axis(art, 2, place.far + 34, _AXIS)
    draw_lens(art, _LENS, _AXIS, 54)
    for side in (1, -1):
        rim = (_LENS, _AXIS + side * place.half)
        start = (2, _AXIS + side * place.half * 0.15)
        art.ray([start, rim], "red", heads=((0, 0.35),), part="incoming")
        art.ray([rim, apex, (place.far, _AXIS - side * beyond)], "red", part="rays")
    stop = [[(_LENS, _AXIS + side * y) for y in (place.half, _RIM)] for side in (1, -1)]
    draw_lines(art, stop, "ink", 2.8, part="stop")


def _draw_distances(art: Any, place: _Layout, words: dict[str, str]) -> None:
    if not place.to_scale:
        art.axis_break(((_LENS + place.near) / 2, _AXIS))
    helpers = [[(_LENS, _AXIS - _RIM - 4), (_LENS, _ROWS[1] - 3)]]
    sharp, sensor = (place.apex, "z_p", _AXIS - 5), (place.sensor, "z_s", _AXIS - 58)
    order = (sharp, sensor) if place.sensor >= place.apex else (sensor, sharp)
    for (x, name, start), row in zip(order, _ROWS, strict=True):
        helpers.append([(x, start), (x, row - 3)])
        art.measure((_LENS, row), (x, row), words[name], side="r")
    draw_lines(art, helpers)


def _draw_diameters(art: Any, place: _Layout, words: dict[str, str]) -> None:
    """Measure both diameters beside the drawing; labels stand above their arrows."""
    left, right = _LENS - 22, place.far + 16
    helpers = []
    for x, start, half in ((left, _LENS - 3, place.half), (right, place.sensor + 3, place.disc)):
        helpers += [[(start, _AXIS + y), (x, _AXIS + y)] for y in (half, -half)]
        if half > 8:
            ends = (x, _AXIS - half), (x, _AXIS + half)
            art.arrow(*ends, "grey", 0.6, size=5.5, both=True, part="diameters")
            continue
        for side in (1, -1):  # no room for two heads: they come from outside
            edge = _AXIS + side * half
            outside = (x, edge + side * 13)
            art.arrow(outside, (x, edge), "grey", 0.6, size=5.5, part="diameters")
    draw_lines(art, helpers)
    align, x = ("c", left) if words["D"] == "$D$" else ("r", _LENS - 5)
    art.label((x, _AXIS + place.half + 6), words["D"], f"{align}b", part="diameters")
    top = place.disc + (6 if place.disc > 8 else 18)
    art.label((right - 4, _AXIS + top), words["c"], "lb", part="diameters")


def _disc(values: Values) -> float:
    return float(values["D"] * abs(values["z_s"] - values["z_p"]) / values["z_p"])


def _label_lengths(values: Values, *, quiz: bool) -> dict[str, str]:
    return {
        "D": "$D$" if quiz else format_statement("$D$", values["D"], "mm"),
        "z_p": format_statement("$z'_p$", values["z_p"], "mm"),
        "z_s": format_statement("$z'_s$", values["z_s"], "mm"),
        "c": format_equation("$c$", _disc(values), "mm", hide=quiz),
    }


MARKS = {"c": "mm"}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(fig: Any, values: Values, marks: dict[str, float]) -> None:
    """Draw a disc of a learner's diameter ``c`` (mm) beside the right one."""
    art, place, right = fig.sketch(zorder=6), _lay_out(values), _disc(values)
    half = abs(marks["c"]) * (place.disc / right if right else place.half / values["D"])
    half, beyond = clamp(half, 0.0, 52.0)
    x = place.sensor - 5
    art.line([(x, _AXIS - half), (x, _AXIS + half)], "gold", 2.6, part="learned")
    for side in (1, -1) if beyond else ():
        art.head((x, _AXIS + side * 60), (0, side), "gold", 9, part="learned")
    text = f"{format_learned(marks['c'])} mm"
    art.label((x, _AXIS + 62), text, "cb", fill="gold", part="learned")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave both diameters out."""
    words = load_alt_words(__file__, lang)
    given = {name: format_given(values[name]) for name in PARAMETERS}
    text: str = words["figure"].format(**given)
    if quiz:
        return text + words["quiz"]
    disc = strip_mathtext(_label_lengths(values, quiz=False)["c"])
    return text + words["answer"].format(D=given["D"], c=disc)
