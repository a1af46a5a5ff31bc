"""Blur disc: the cone of light behind a lens, cut by a sensor that is not where it is sharp.

The distance between sensor and sharp image is drawn 0.2 to 0.4 times as large as z'_p, with a
break mark on the axis where that is not to scale. Aperture, apex and blur disc keep their exact
proportions as drawn.
"""

from __future__ import annotations

from dataclasses import dataclass

from quizgen.figures.kit import (
    BOLD,
    DOTTED,
    LINE,
    RAY,
    SHADE,
    THIN,
    WIDTH,
    Canvas,
    Parameter,
    Pen,
    Style,
    Values,
    equation,
    given,
    spoken,
    statement,
    words_of,
)

DARK = "invert"

PARAMETERS = {
    "D": Parameter("mm", "diameter of the aperture", low=1e-6),
    "z_p": Parameter("mm", "distance z'_p from the lens to the sharp image of the point", low=1e-6),
    "z_s": Parameter("mm", "distance z'_s from the lens to the sensor", low=1e-6),
}

_AXIS, _LENS, _HALF = 108.0, 74.0, 48.0
_ROWS = (22.0, 41.0)
_LEAST, _MOST = 0.2, 0.4


@dataclass(frozen=True, slots=True)
class _Layout:
    """Drawn places: apex and sensor in points, and half the blur disc."""

    apex: float
    sensor: float
    half_disc: float
    to_scale: bool


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, hide the diameters of aperture and blur disc."""
    pen, place = Pen(), _layout(values)
    _cone(pen, place)
    _lens(pen)
    _sensor(pen, place)
    _axis(pen, place)
    _names(pen, place, _labels(values, quiz=quiz))
    pen.onto(canvas)


def _disc(values: Values) -> float:
    return values["D"] * abs(values["z_s"] - values["z_p"]) / values["z_p"]


def _layout(values: Values) -> _Layout:
    ratio = (values["z_s"] - values["z_p"]) / values["z_p"]
    size = min(max(abs(ratio), _LEAST), _MOST) if ratio else 0.0
    drawn = size if ratio >= 0 else -size
    length = 152.0 / max(1.0, 1 + drawn)
    apex, sensor = _LENS + length, _LENS + length * (1 + drawn)
    return _Layout(apex, sensor, _HALF * size, size == abs(ratio))


def _cone(pen: Pen, place: _Layout) -> None:

    end = max(place.sensor, place.apex)
    beyond = _HALF * (end - place.apex) / (place.apex - _LENS)
    edge = [
        (_LENS, _AXIS + _HALF),
        (place.apex, _AXIS),
        (end, _AXIS + beyond),
        (end, _AXIS - beyond),
        (place.apex, _AXIS),
        (_LENS, _AXIS - _HALF),
    ]
    pen.area("cone", edge, SHADE)
    for side in (1, -1):
        pen.line("incoming", [(4, _AXIS), (_LENS, _AXIS + side * _HALF)], RAY)
        rim = (_LENS, _AXIS + side * _HALF)
        pen.ray("rays", [rim, (place.apex, _AXIS), (end, _AXIS - side * beyond)])


def _lens(pen: Pen) -> None:

    rim = [(7 * (1 - (i / 10) ** 2), _HALF * i / 10) for i in range(-10, 11)]
    shape = [(_LENS + x, _AXIS + y) for x, y in rim] + [(_LENS - x, _AXIS - y) for x, y in rim]
    pen.area("lens", shape, SHADE)
    pen.area("lens-edge", shape, LINE)
    for side in (1, -1):
        pen.line("stop", [(_LENS, _AXIS + side * _HALF), (_LENS, _AXIS + side * 60)], BOLD)


def _sensor(pen: Pen, place: _Layout) -> None:

    pen.line("sensor", [(place.sensor, _AXIS - 52), (place.sensor, _AXIS + 52)], LINE)
    disc = [(place.sensor, _AXIS - place.half_disc), (place.sensor, _AXIS + place.half_disc)]
    pen.line("disc", disc, Style(3.2))
    pen.dot("apex", (place.apex, _AXIS), 2.4)


def _axis(pen: Pen, place: _Layout) -> None:

    pen.line("axis", [(4, _AXIS), (WIDTH - 4, _AXIS)], THIN)
    for x in (_LENS, place.apex, place.sensor):
        row = _ROWS[1] if x == min(place.apex, place.sensor) else _ROWS[0]
        pen.line("helpers", [(x, _AXIS - 4), (x, row - 4)], DOTTED)
    if not place.to_scale:
        pen.break_mark(((_LENS + min(place.apex, place.sensor)) / 2, _AXIS))


def _names(pen: Pen, place: _Layout, words: dict[str, str]) -> None:

    far, near = ("z_s", "z_p") if place.sensor > place.apex else ("z_p", "z_s")
    ends = {"z_s": place.sensor, "z_p": place.apex}
    pen.dimension((_LENS, _ROWS[1]), (ends[near], _ROWS[1]), words[near])
    pen.dimension((_LENS, _ROWS[0]), (ends[far], _ROWS[0]), words[far])
    _upright(pen, _LENS - 18, _HALF)
    pen.label((5, _AXIS - 60), words["D"], "l")
    x = max(place.sensor, place.apex) + 10
    for side in (1, -1):
        y = _AXIS + side * place.half_disc
        pen.line("helpers-disc", [(place.sensor + 3, y), (x + 3, y)], THIN)
    _upright(pen, x, place.half_disc)
    pen.label((x - 5, _AXIS + max(place.half_disc, 9) + 13), words["c"], "l")


def _upright(pen: Pen, x: float, half: float) -> None:
    """Draw a vertical double arrow about the axis; from outside where there is no room inside."""
    for side in (1, -1):
        start = 0.0 if half > 8 else half + 14
        pen.arrow("diameters", (x, _AXIS + side * start), (x, _AXIS + side * half), THIN)


def _labels(values: Values, *, quiz: bool) -> dict[str, str]:
    return {
        "D": "D" if quiz else statement("D", values["D"], "mm"),
        "z_p": statement("z'_p", values["z_p"], "mm"),
        "z_s": statement("z'_s", values["z_s"], "mm"),
        "c": equation("c", _disc(values), "mm", hide=quiz),
    }


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave both diameters out."""
    words = words_of(__file__, lang)
    text = words["figure"].format(z_p=given(values["z_p"]), z_s=given(values["z_s"]))
    if quiz:
        return text + words["quiz"]
    told = spoken(_labels(values, quiz=False)["c"])
    return text + words["answer"].format(D=given(values["D"]), c=told)
